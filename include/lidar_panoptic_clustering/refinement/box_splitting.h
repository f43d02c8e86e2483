#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"
#include "lidar_panoptic_clustering/geometry/planar_cells.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Parts one object where its points hang together least in bird's-eye view.
///
/// The link distance is lowered by tenths of `reach`, from nine down to two, until two or more sizeable parts are left:
/// a tenth of the object's points each, and at least ten. What is not in one of them joins the nearest of them
/// (outline to outline).
///
/// Nine passes over the points at the most; keeps its memory.
class BoxSplitter
{
public:
  static constexpr int kCoarsest = 9;  ///< tenths of the reach to begin with

  /// `things`: the object's `count` points, indices into the scan. `tenths`: where to begin, at most kCoarsest; becomes
  /// the distance found, where the parts hang together, so that each of them need only be looked at below it. Returns
  /// the number of parts, 1 where the object hangs together; else `part` holds each thing's part, 0..n-1, parallel to
  /// `things`.
  std::uint32_t split(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float reach, int& tenths,
                      std::vector<std::uint32_t>& part);

private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  void link(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float distance);
  std::uint32_t countSizeable(std::uint32_t fewest);
  void joinRest(const ThingScan& scan, const std::uint32_t* things, std::uint32_t parts);

  PlanarCells cells_;
  std::vector<float> distance_;  ///< the one link distance
  std::vector<std::uint32_t> component_of_cell_;
  std::vector<std::uint32_t> size_of_, part_of_;  ///< by component
  std::vector<Footprint> outline_;                ///< by component
  std::vector<std::uint32_t> sizeable_;           ///< by part: its component
};
}  // namespace lidar_panoptic_clustering
