#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/tracking/observation.h"
#include "lidar_panoptic_clustering/tracking/tracker.h"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Decides by the points of instances which of them are several objects that a scan has merged.
///
/// - Tracks that an instance should hold (Tracker::findMerged) are parts of it where together they are clearly larger
///   than one object of the class, or where hardly a point lies half way between them.
/// - An instance of people that holds no such tracks and is as long as one with arms and legs apart is cut at its
///   holes: a body has none of a quarter of a metre.
/// - An instance of a small class, people or bicycles, that holds no such tracks and is larger than one of them usually
///   is, is cut across where hardly a point lies between two halves: two that were never seen apart.
///
/// Linear in the points of the instances in question; keeps its memory. Not shared between threads.
class InstanceParting
{
public:
  /// Throws std::invalid_argument without a table.
  explicit InstanceParting(std::shared_ptr<const ClassTable> table);

  /// Begins a scan; both stay valid until finish(). Returns whether any instance is in question.
  bool begin(const Observations& observations, const std::vector<Tracker::Share>& shares);
  /// Whether the points of an instance, by its place, are wanted.
  bool wants(std::uint32_t place) const { return begin_[place + 1] > begin_[place]; }
  /// Adds a point with finite coordinates, in the axes of the fixed frame from Observations::origin [m].
  void add(std::uint32_t place, const Eigen::Vector2f& point) { points_[filled_[place]++] = point; }
  /// The parts of the instances that are parted, two or more each; by instance, valid until the next begin().
  const std::vector<Tracker::Share>& finish();

private:
  using Point = Eigen::Vector2f;
  bool isOversized(const Observation& observation) const;
  bool isLongBody(const Observation& observation) const;
  std::size_t nearestShare(const Point& point, std::size_t first, std::size_t last) const;
  void keepClear(std::uint32_t place, std::size_t first, std::size_t last);
  void cut(std::uint32_t place);
  void cutAtHoles(std::uint32_t place);
  void sortAlong(std::uint32_t place, const Point& axis);
  template <class Counts>
  float shareHalfWay(std::uint32_t place, const Point& from, const Point& to, const Counts& counts) const;
  bool findHalves(std::uint32_t place, const Point& axis, float& from, float& to) const;

  std::shared_ptr<const ClassTable> table_;
  const Observations* observations_ = nullptr;
  const std::vector<Tracker::Share>* shares_ = nullptr;
  std::vector<std::uint32_t> begin_, filled_;  ///< by place, in points_
  std::vector<Point> points_;
  std::vector<float> along_;       ///< the points of the instance in hand along an axis, in order
  std::vector<float> cuts_;        ///< places between its pieces along that axis
  std::vector<std::size_t> kept_;  ///< of the shares of the instance in hand
  std::vector<Tracker::Share> parts_;
};
}  // namespace lidar_panoptic_clustering
