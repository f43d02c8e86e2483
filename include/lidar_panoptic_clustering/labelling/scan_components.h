#pragma once

#include "lidar_panoptic_clustering/core/disjoint_sets.h"
#include "lidar_panoptic_clustering/core/footprint.h"
#include "lidar_panoptic_clustering/core/point_types.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What hangs together among the returns that stand above the ground.
struct ScanComponent
{
  std::uint32_t point_count = 0;
  float bottom = 0.0F, top = 0.0F;       ///< [m] above the ground
  float x = 0.0F, y = 0.0F;              ///< mean [m]
  std::uint32_t triples = 0, rough = 0;  ///< of consecutive returns in a row
  std::uint32_t edges = 0, undercut = 0, feet = 0;
  bool open_top = false;
  Footprint footprint;
};

/// Connected components of an organised cloud's returns on the range image.
///
/// A return's neighbours are the nearest return of interest to its left and above, up to three columns and two rows
/// away. Two neighbours hang together when they are closer than `link_distance`, or when they lie no steeper to the
/// beam than 60 degrees off the perpendicular, as neighbours of a coarse sensor far out do.
///
/// Linear in the pixels; keeps its memory.
class ScanComponents
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Takes the points whose `height` is at least `above`; `full_turn`: the last column is the first one's neighbour.
  void find(const LabelledCloud& cloud, const std::vector<float>& height, float above, float link_distance,
            bool full_turn);

  const std::vector<ScanComponent>& list() const { return components_; }
  /// The component of a pixel, kNone for those without.
  std::uint32_t of(std::size_t pixel) const { return component_of_[pixel]; }

private:
  void gather(const LabelledCloud& cloud, const std::vector<float>& height);

  DisjointSets sets_;
  std::vector<std::uint32_t> component_of_;
  std::vector<std::uint32_t> above_;  ///< by column: the last row of interest
  std::vector<ScanComponent> components_;
};
}  // namespace lidar_panoptic_clustering
