#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Splits the thing points of a scan into objects by geometry: the one step that differs between algorithms.
///
/// What the pipeline and the tests of all algorithms count on, whatever the rule:
/// - points whose ThingScan::link differs are never one object, nor are neighbours that are ThingScan::linkDistance()
///   apart or more; a rule may join less;
/// - where ThingScan::full_turn is set, the last column is the first one's neighbour: a rule that goes by columns has
/// to
///   look over the end of a row, column + k modulo ThingScan::columns, or an object there is found in two parts;
/// - the partition depends on the points alone: not on which row or column comes first, nor on calls before;
/// - no points, one point, one row and one column are scans too.
///
/// A derived class has a struct `Config` with its parameters (core/parameters.h) and a constructor from it, which
/// throws std::invalid_argument on a value outside its range; doc/architecture.md says what else a new algorithm needs.
/// An object may keep buffers between calls and is not shared between threads.
class Clusterer
{
public:
  virtual ~Clusterer() = default;

  /// Gives every thing point a component: resized to scan.size(), each value below scan.size(), two points have the
  /// same value exactly when they belong to the same object. The values' order means nothing. Expected to be linear in
  /// the points, or little more; does not throw.
  virtual void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) = 0;

  /// Whether the rule goes by rows and columns, so that it makes no sense on one row of points in any order, as of
  /// several lidars merged into one cloud.
  virtual bool needsScanLines() const { return false; }
};
}  // namespace lidar_panoptic_clustering
