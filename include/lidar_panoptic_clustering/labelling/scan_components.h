#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"
#include "lidar_panoptic_clustering/labelling/ground_surface.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Returns above the ground that hang together, and what of them tells an object from a wall or a tree.
struct ScanComponent
{
  std::uint32_t point_count = 0;
  float bottom = 0.0F, top = 0.0F;  ///< [m] above the ground
  Footprint footprint;

  bool open_top = false;  ///< goes up to the highest beams: there may be more of it above

  /// Places where a return of the ground lies under one of the component in a column, and those of them where the
  /// ground is seen to go on underneath, as it does under vehicles and between legs, not at the foot of a wall.
  std::uint32_t feet = 0, undercut_feet = 0;

  /// Triples of neighbours in a scan line, and those that no smooth surface has, as foliage.
  std::uint32_t triples = 0, rough_triples = 0;
};

/// The connected components of the returns above the ground, on the range image.
///
/// A return's neighbours are the next such returns beside it and above it, up to 8 columns and 4 rows away (a window, a
/// missing return). Two neighbours hang together when they are closer than `link_distance`, or when the surface
/// through them is within 60 degrees of upright to the beam, as far out, where neighbouring beams part.
///
/// Linear in the pixels; keeps its memory.
class ScanComponents
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Takes the returns at least `above` [m] over the ground. `full_turn`: the last column is the first one's neighbour.
  /// Rows may run from the highest beam down or from the lowest up.
  void find(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, float above, float link_distance,
            bool full_turn);

  /// Numbered by first pixel in row-major order.
  const std::vector<ScanComponent>& list() const { return components_; }
  /// The component of a pixel, kNone for those without.
  std::uint32_t of(std::size_t pixel) const { return component_of_[pixel]; }

private:
  void link(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, float above, float link_distance,
            bool full_turn);
  void gather(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns);
  void examineTops(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, bool highest_first);
  void examineFeet(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, bool highest_first);
  void examineSurfaces(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns);

  DisjointSets sets_;
  std::vector<std::uint32_t> component_of_;
  std::vector<std::uint32_t> pixels_;      ///< of the returns above the ground, in row-major order
  std::vector<std::uint32_t> row_before_;  ///< by column: the last row of a return above the ground
  std::vector<ScanComponent> components_;
};
}  // namespace lidar_panoptic_clustering
