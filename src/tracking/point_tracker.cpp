#include "lidar_panoptic_clustering/tracking/point_tracker.h"

#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = SparseAssignment::kNone;
}

PointTracker::PointTracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config)
    : tracker_(table, config), builder_(table)
{
}

void PointTracker::begin(std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor)
{
  stamp_us_ = stamp_us;
  pose_ = fixed_from_sensor;
  points_.clear();
}

void PointTracker::finish()
{
  observe();
  const std::vector<Tracker::Share>& shares = tracker_.findMerged(stamp_us_, *seen_);
  if (!shares.empty())
  {
    part(shares);
    observe();
  }
  objects_ = &tracker_.update(stamp_us_, *seen_);
}

void PointTracker::observe()
{
  builder_.begin(pose_);
  place_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    const Point& p = points_[i];
    place_[i] = builder_.add(p.instance, p.class_index, p.x, p.y, p.z);
  }
  seen_ = &builder_.finish();
}

/// Numbers instances by their place, and those of shares beyond.
void PointTracker::part(const std::vector<Tracker::Share>& shares)
{
  const auto count = static_cast<std::uint32_t>(seen_->list.size());
  first_share_.assign(count, kNone);
  for (std::uint32_t s = 0; s < shares.size(); ++s)
    if (first_share_[shares[s].observation] == kNone) first_share_[shares[s].observation] = s;
  const Eigen::Matrix3f rotation = pose_.linear().cast<float>();
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    Point& point = points_[i];
    const std::uint32_t place = place_[i];
    point.instance = place + 1;
    if (first_share_[place] == kNone) continue;
    const Eigen::Vector3f p = rotation * Eigen::Vector3f(point.x, point.y, point.z);
    std::uint32_t nearest = first_share_[place];
    float least = Extent::kFar;
    for (std::uint32_t s = first_share_[place]; s < shares.size() && shares[s].observation == place; ++s)
    {
      const float distance = shares[s].outline.distanceTo(p.x(), p.y());
      if (distance < least) least = distance, nearest = s;
    }
    point.instance = count + 1 + nearest;
  }
}
}  // namespace lidar_panoptic_clustering
