#pragma once

#include "lidar_panoptic_clustering/tracking/instance_parting.h"
#include "lidar_panoptic_clustering/tracking/observation.h"
#include "lidar_panoptic_clustering/tracking/tracker.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Ids that last for the points of scans: Tracker, and before it the instances that are several objects are parted (see
/// InstanceParting), each point going to the part whose outline it is in or nearest to.
///
/// Keeps its memory between scans; linear in the points. Not shared between threads.
class PointTracker
{
public:
  /// Throws std::invalid_argument without a table, and on a value outside its range.
  explicit PointTracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config = {});

  Tracker& tracker() { return tracker_; }              ///< what follows the outlines
  const Tracker& tracker() const { return tracker_; }  ///< the same

  /// Begins a scan; `fixed_from_sensor`: where the sensor is in the frame that objects are followed in.
  void begin(std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor);
  /// Adds a point of an instance (any id but 0), in the sensor frame [m].
  void add(std::uint32_t instance, ClassIndex class_index, float x, float y, float z)
  {
    points_.push_back({x, y, z, class_index});
    place_.push_back(builder_.add(instance, class_index, x, y, z));
  }
  /// Follows the instances.
  void finish();

  /// The object of the i-th point that was added; valid until the next finish().
  const TrackedObject& objectOf(std::size_t i) const { return (*objects_)[place_[i]]; }
  /// Its place in objects() and observations(); likewise.
  std::uint32_t placeOf(std::size_t i) const { return place_[i]; }
  /// The scan's objects, and what was seen of each: parallel, several of them may be parts of one track.
  const std::vector<TrackedObject>& objects() const { return *objects_; }
  const std::vector<Observation>& observations() const { return seen_->list; }  ///< likewise, parallel to objects()

private:
  struct Point
  {
    float x, y, z;
    ClassIndex class_index;
  };
  Eigen::Vector2f inFixedAxes(const Point& point) const;
  const std::vector<Tracker::Share>& findParts();
  bool part(const std::vector<Tracker::Share>& parts);

  Tracker tracker_;
  ObservationBuilder builder_;
  InstanceParting parting_;
  std::int64_t stamp_us_ = 0;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix3f rotation_ = Eigen::Matrix3f::Identity();  ///< the pose's
  std::vector<Point> points_;
  std::vector<std::uint32_t> place_;       ///< by point, in the list of observations
  std::vector<std::uint32_t> first_part_;  ///< by observation: the first of its parts, kNone for none
  const Observations* seen_ = nullptr;
  const std::vector<TrackedObject>* objects_ = nullptr;
};
}  // namespace lidar_panoptic_clustering
