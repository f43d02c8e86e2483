#include "lidar_panoptic_clustering/tracking/point_tracker.h"

#include "core/make_room.h"

#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = SparseAssignment::kNone;
}

PointTracker::PointTracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config)
    : tracker_(table, config), builder_(table), parting_(table)
{
}

void PointTracker::begin(std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor)
{
  stamp_us_ = stamp_us;
  pose_ = fixed_from_sensor;
  rotation_ = pose_.linear().cast<float>();
  points_.clear(), place_.clear();
  builder_.begin(pose_);
}

void PointTracker::finish()
{
  seen_ = &builder_.finish();
  const bool is_parted = parting_.begin(*seen_, tracker_.findMerged(stamp_us_, *seen_)) && part(findParts());
  objects_ = is_parted ? &tracker_.update(stamp_us_, *seen_) : &tracker_.updateMatched(stamp_us_, *seen_);
}

/// Not finite where a coordinate is not: a product with 0 is NaN then.
Eigen::Vector2f PointTracker::inFixedAxes(const Point& point) const
{
  return (rotation_ * Eigen::Vector3f(point.x, point.y, point.z)).head<2>();
}

const std::vector<Tracker::Share>& PointTracker::findParts()
{
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    if (!parting_.wants(place_[i])) continue;
    const Eigen::Vector2f p = inFixedAxes(points_[i]);
    if (p.allFinite()) parting_.add(place_[i], p);
  }
  return parting_.finish();
}

/// Observes the scan again where there are parts: instances numbered by their place, and those of parts beyond.
bool PointTracker::part(const std::vector<Tracker::Share>& parts)
{
  if (parts.empty()) return false;
  const auto count = static_cast<std::uint32_t>(seen_->list.size());
  makeRoom(first_part_, count);
  first_part_.assign(count, kNone);
  for (std::uint32_t k = 0; k < parts.size(); ++k)
    if (first_part_[parts[k].observation] == kNone) first_part_[parts[k].observation] = k;
  builder_.begin(pose_);
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    const Point& point = points_[i];
    const std::uint32_t place = place_[i];
    std::uint32_t instance = place + 1;
    if (first_part_[place] != kNone)
    {
      const Eigen::Vector2f p = inFixedAxes(point);
      std::uint32_t nearest = first_part_[place];
      float least = Extent::kFar;
      for (std::uint32_t k = first_part_[place]; k < parts.size() && parts[k].observation == place; ++k)
      {
        const float distance = parts[k].outline.distanceTo(p.x(), p.y());
        if (distance < least) least = distance, nearest = k;
      }
      instance = count + 1 + nearest;
    }
    place_[i] = builder_.add(instance, point.class_index, point.x, point.y, point.z);
  }
  seen_ = &builder_.finish();
  return true;
}
}  // namespace lidar_panoptic_clustering
