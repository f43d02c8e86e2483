#include "ros/label_matcher.h"

#include <pcl_conversions/pcl_conversions.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace lidar_panoptic_clustering
{
namespace
{
/// At least a microsecond: stamps that went through a PCL header lack what is below it, cut off or rounded.
std::uint64_t toleranceOf(const LabelMatcherConfig& config)
{
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(config.sync_tolerance_s * 1e6)));
}
}  // namespace

std::uint64_t microseconds(const std_msgs::Header& header)
{
  std::uint64_t stamp = 0;
  pcl_conversions::toPCL(header.stamp, stamp);
  return stamp;
}

LabelMatcher::LabelMatcher(const LabelMatcherConfig& config)
    : queue_size_(config.queue_size),
      tolerance_(toleranceOf(config)),
      matcher_(static_cast<std::size_t>(config.queue_size), tolerance_)
{
}

std::optional<LabelMatcher::Pair> LabelMatcher::addCloud(const sensor_msgs::PointCloud2ConstPtr& cloud)
{
  newest_cloud_ = cloud->header.stamp;
  return matcher_.addLeft(microseconds(cloud->header), {cloud, nullptr});
}

std::optional<LabelMatcher::Pair> LabelMatcher::addLabels(const std_msgs::Header& header, const LabelPart& labels)
{
  newest_labels_ = header.stamp;
  return matcher_.addRight(microseconds(header), labels);
}

std::uint64_t LabelMatcher::takeDropped()
{
  const std::uint64_t before = std::exchange(told_, matcher_.unmatchedLeft());
  return told_ - before;
}

std::string LabelMatcher::describeLack(const std::string& labels_topic) const
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "expected labels on " << labels_topic << " with a stamp at most " << tolerance_
       << " us from the cloud's, before " << queue_size_
       << " more clouds and before a later cloud's labels; found clouds up to stamp " << newest_cloud_ << " and ";
  if (newest_labels_.isZero())
    text << "no labels";
  else
    text << "labels up to " << newest_labels_;
  return text.str();
}
}  // namespace lidar_panoptic_clustering
