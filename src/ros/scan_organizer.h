#pragma once

#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "lidar_panoptic_clustering/projection/original_cloud.h"
#include "lidar_panoptic_clustering/projection/original_labeller.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_labeller.h"
#include "ros/frame_history.h"
#include "ros/label_matcher.h"

#include <sensor_msgs/PointCloud2.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
struct ScanOrganizerConfig
{
  OrganizerConfig organizer;
  ScanLabellerConfig labeller;
  bool float_fields = false;  ///< label and instance of ~output_original as float32, as pcl_ros's filters read them
  bool lasting_ids = false;   ///< ~panoptic is a tracker's output, see OriginalLabeller

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    OrganizerConfig::visit(self.organizer, visitor);
    ScanLabellerConfig::visit(self.labeller, visitor);
    visitor("float_fields", self.float_fields);
    visitor("lasting_ids", self.lasting_ids);
  }
};

/// What OrganizerNodelet makes of messages, without its topics: a driver's cloud organised and labelled, and back.
/// Each step throws std::exception's descendants for what cannot be used. Not shared between threads.
class ScanOrganizer
{
public:
  /// Throws std::invalid_argument or std::runtime_error for a configuration that cannot be used.
  explicit ScanOrganizer(const ScanOrganizerConfig& config);

  /// Fills the frame's scan and organize_ms.
  void organize(const sensor_msgs::PointCloud2& message, OrganizedFrame& frame);

  /// Gives the scan its labels, from `labels` where they come separately; with `all_points` those too that the image
  /// does not show. Returns the milliseconds it took.
  double label(const sensor_msgs::PointCloud2& message, const LabelPart& labels, bool all_points,
               OrganizedFrame& frame);

  /// The frame's image itself, to go out by pointer; its size stays behind, for carryBack().
  LabelledCloud::Ptr takeImage(const std_msgs::Header& header, OrganizedScan& scan);

  /// The frame's message with the label and the instance of each point, as the clustered image has them.
  sensor_msgs::PointCloud2Ptr carryBack(const OrganizedFrame& frame, const PanopticCloud& panoptic);

  /// Whether labels come on a topic of their own.
  bool isSeparate() const { return config_.labeller.separate(); }
  const Organizer& organizer() const { return organizer_; }
  /// Of the scan labelled last, where labels come from the geometry; else nothing.
  std::optional<GroundReport> ground() const
  {
    if (config_.labeller.labels != "none") return std::nullopt;
    return labeller_.ground();
  }
  /// What is doubtful about the labels, see ScanLabeller::doubt().
  const std::string& doubt() const { return labeller_.doubt(); }

private:
  CloudPool<LabelledCloud> pool_;
  ScanOrganizerConfig config_;
  ScanLabeller labeller_;
  Organizer organizer_;
  OriginalLabeller original_labeller_;
  std::vector<std::uint32_t> label_, instance_;  ///< by sent point
  OriginalCloud labelled_;
};
}  // namespace lidar_panoptic_clustering
