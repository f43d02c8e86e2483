#pragma once

#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"
#include "ros/instance_markers.h"
#include "ros/latched_input.h"
#include "ros/mailbox.h"
#include "ros/object_outputs.h"
#include "ros/stream_diagnostics.h"

#include <dynamic_reconfigure/server.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace lidar_panoptic_clustering
{
/// What all clustering nodelets share: ~input organised LabelledCloud -> ~output PanopticCloud of the same points,
/// ~objects the object list, which also goes out as ~markers and, where vision_msgs was there, as ~detections; ~stages
/// figures of each scan (things, instances, milliseconds a stage; hardware_id is the algorithm), /diagnostics.
/// Subscribes only while someone listens to one of the first four, and works only on the outputs that are listened to.
///
/// The callback puts the newest scan into a mailbox of one; a thread of the nodelet's own works on it. A scan that
/// cannot be used is dropped, logged and shown in the diagnostics; the next one is looked at afresh. The scan of a
/// latched input is worked on once a second, for those who begin to listen later.
///
/// Parameters: ~class_table, a table that ships with the package or a YAML file; and those of the algorithm.
class ClusterNodelet : public nodelet::Nodelet
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

  void onInit() final;

  /// To be called at the beginning of the most derived destructor: ends the thread and all callbacks.
  void shutdown();

private:
  using CloudPtr = boost::shared_ptr<const LabelledCloud>;

  void load();
  void advertise();
  void connect();
  Idle describeIdle();
  std::uint32_t listeners() const
  {
    return output_.getNumSubscribers() + markers_.getNumSubscribers() + objects_.listeners();
  }
  void refuse(const std::string& error);
  void work();
  void process(const LabelledCloud& cloud);
  void publishObjects(const pcl::PCLHeader& header);
  void publishStages(const pcl::PCLHeader& header, const StreamDiagnostics::StageMilliseconds& stages);
  void warnOfUnknownLabels();

  const std::string algorithm_;
  CloudPool<PanopticCloud> pool_;
  std::unique_ptr<FramePipeline> pipeline_;  ///< the thread's own once it runs
  InstanceBoxes boxes_;
  InstanceMarkers marker_list_;
  std::set<std::uint32_t> warned_labels_;
  StreamDiagnostics diagnostics_;

  std::mutex pending_mutex_;
  std::optional<Algorithm> pending_;  ///< waits for the next scan

  std::mutex connect_mutex_;
  bool closed_ = false;
  ros::Publisher output_, markers_, stages_;
  ObjectOutputs objects_;
  ros::Subscriber input_;
  LatchedInput<LabelledCloud> latched_;
  Mailbox<CloudPtr> mailbox_;
  std::thread thread_;
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
