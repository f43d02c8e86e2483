#pragma once

#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"
#include "ros/instance_markers.h"
#include "ros/object_nodelet.h"

#include <dynamic_reconfigure/server.h>
#include <ros/ros.h>

#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
/// What all clustering nodelets share: organised LabelledCloud in, its objects out (see ObjectNodelet); ~stages figures
/// of each scan (things, instances, milliseconds a stage; hardware_id is the algorithm). Works only on the outputs that
/// are listened to.
///
/// Parameters: ~class_table, a table that ships with the package or a YAML file; and those of the algorithm.
class ClusterNodelet : public ObjectNodelet<LabelledCloud>
{
public:
  explicit ClusterNodelet(std::string algorithm) : algorithm_(std::move(algorithm)) {}

protected:
  /// Makes the dynamic_reconfigure server, which calls reconfigure().
  virtual void startReconfigure() = 0;
  /// Stops it before the members here go.
  virtual void stopReconfigure() = 0;

  /// Takes effect with the next scan. Throws std::invalid_argument and changes nothing when a value cannot be used.
  void reconfigure(const dynamic_reconfigure::Config& message);

private:
  Work load() final;
  void advertiseMore() final;
  void process(const Scan& scan);
  void stop() final;
  void publishObjects(const pcl::PCLHeader& header);
  void publishStages(const pcl::PCLHeader& header, const StreamDiagnostics::StageMilliseconds& stages);
  void warnOfUnknownLabels();

  const std::string algorithm_;
  std::unique_ptr<FramePipeline> pipeline_;  ///< the thread's own once it runs
  InstanceBoxes boxes_;
  InstanceMarkers marker_list_;
  std::set<std::uint32_t> warned_labels_;

  std::mutex pending_mutex_;
  std::optional<Algorithm> pending_;  ///< waits for the next scan

  ros::Publisher stages_;
};

/// A clustering nodelet tuned by `Reconfigure`, the class generated from the algorithm's .cfg file.
template <class Reconfigure>
class TunableClusterNodelet : public ClusterNodelet
{
public:
  using ClusterNodelet::ClusterNodelet;
  ~TunableClusterNodelet() override { shutdown(); }

private:
  void startReconfigure() override
  {
    server_ = std::make_unique<dynamic_reconfigure::Server<Reconfigure>>(getPrivateNodeHandle());
    server_->setCallback(
        [this](Reconfigure& config, std::uint32_t)
        {
          dynamic_reconfigure::Config message;
          config.__toMessage__(message);
          try
          {
            reconfigure(message);
            accepted_ = config;
          }
          catch (const std::exception& error)
          {
            NODELET_ERROR("not reconfigured: %s", error.what());
            config = accepted_;
          }
        });
  }
  void stopReconfigure() override { server_.reset(); }

  Reconfigure accepted_ = Reconfigure::__getDefault__();
  std::unique_ptr<dynamic_reconfigure::Server<Reconfigure>> server_;
};
}  // namespace lidar_panoptic_clustering
