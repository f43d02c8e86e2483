#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Splits the thing points of a scan into objects by geometry: the one step that differs between algorithms.
///
/// An object may keep buffers between calls and is not shared between threads.
class Clusterer
{
public:
  virtual ~Clusterer() = default;

  /// Gives every thing point a component: resized to scan.size(), each value below scan.size(), two points have the
  /// same value exactly when they belong to the same object. The values' order means nothing.
  virtual void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) = 0;

  /// Whether the rule goes by rows and columns, so that it makes no sense on one row of points in any order, as of
  /// several lidars merged into one cloud.
  virtual bool needsScanLines() const { return false; }
};
}  // namespace lidar_panoptic_clustering
