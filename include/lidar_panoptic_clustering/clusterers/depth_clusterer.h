#pragma once

#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"

namespace lidar_panoptic_clustering
{
/// The parameters of DepthClusterer.
struct DepthConfig
{
  double theta_deg = 10.0;      ///< smallest angle between the line of sight and the line through both points
  int max_gap_px = 9;           ///< neighbours are at most this many pixels apart
  double max_distance_m = 0.0;  ///< and at most this far in space; 0: only the classes' link distance

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("theta_deg", self.theta_deg, 0.1, 89.0);
    visitor("max_gap_px", self.max_gap_px, 1, 100);
    visitor("max_distance_m", self.max_distance_m, 0.0, 100.0);
  }
};

/// Depth clustering on the range image (Bogoslavskyi and Stachniss, "Fast Range Image-Based Segmentation of Sparse 3D
/// Laser Scans for Online Operation", IROS 2016, section III; settings of Zhao et al. 2021).
///
/// A pixel's neighbours are, up, down, left and right, the next linkable thing point at most max_gap_px pixels away;
/// pixels that hold none are skipped. Neighbours A (the farther) and B, seen under the angle a, are one object when
/// beta = atan2(|B| sin a, |A| - |B| cos a) > theta, written without trigonometry as |A x D| > tan(theta) (A . D) with
/// D = A - B, and they are closer than their link distance. Equal points are one object. On a full turn the last column
/// neighbours the first.
///
/// Linear in the thing points.
class DepthClusterer : public Clusterer
{
public:
  /// For the factory.
  using Config = DepthConfig;

  /// Throws std::invalid_argument on a value outside its range.
  explicit DepthClusterer(const DepthConfig& config = {});

  void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) override;
  bool needsScanLines() const override { return true; }

  /// Pairs of points compared in the last scan, for tests that bound the work.
  std::size_t pairsLookedAt() const { return looked_at_; }

private:
  /// A point to look back at, and its position along the line of search.
  struct Last
  {
    std::uint32_t point, position;
  };

  void linkAlongLines(const ThingScan& scan);
  void linkAlongColumns(const ThingScan& scan);
  void link(const ThingScan& scan, std::uint32_t a, std::uint32_t b);

  float squared_tan_theta_;
  float max_squared_distance_;
  std::uint32_t max_gap_px_;
  DisjointSets sets_;
  std::size_t looked_at_ = 0;
  std::vector<Last> last_, first_;  ///< by link key, of the line in hand
  std::vector<Last> last_above_;    ///< by column and link key
};
}  // namespace lidar_panoptic_clustering
