#pragma once

#include "ros/stamp_matcher.h"

#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
struct LabelMatcherConfig
{
  double sync_tolerance_s = 0.0;  ///< between the stamps of a cloud and its labels; 0: the same to a microsecond
  int queue_size = 10;            ///< clouds that wait for labels, or labels for clouds; each is a scan in memory

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("sync_tolerance_s", self.sync_tolerance_s, 0.0, 10.0);
    visitor("queue_size", self.queue_size, 1, 1000);
  }
};

/// [us], as a PCL header keeps it.
std::uint64_t microseconds(const std_msgs::Header& header);

/// A cloud, or the labels of one.
struct LabelPart
{
  sensor_msgs::PointCloud2ConstPtr cloud;
  sensor_msgs::ImageConstPtr image;
};

/// Lets clouds wait until labels of their stamp come, and counts those that wait in vain: what more than queue_size
/// others have overtaken, or whose successor's labels have come. Not shared between threads.
class LabelMatcher
{
public:
  using Pair = std::pair<LabelPart, LabelPart>;  ///< a cloud and its labels

  explicit LabelMatcher(const LabelMatcherConfig& config);

  std::optional<Pair> addCloud(const sensor_msgs::PointCloud2ConstPtr& cloud);
  std::optional<Pair> addLabels(const std_msgs::Header& header, const LabelPart& labels);

  /// How many clouds were let go since the last call.
  std::uint64_t takeDropped();
  /// What they lacked: what was expected on the topic of labels, and what came.
  std::string describeLack(const std::string& labels_topic) const;

  std::size_t waiting() const { return matcher_.waitingLeft(); }
  std::uint64_t labelsWithoutCloud() const { return matcher_.unmatchedRight(); }

private:
  int queue_size_;
  std::uint64_t tolerance_;          ///< [us]
  StampMatcher<LabelPart> matcher_;  ///< left: clouds, right: labels
  ros::Time newest_cloud_, newest_labels_;
  std::uint64_t told_ = 0;
};
}  // namespace lidar_panoptic_clustering
