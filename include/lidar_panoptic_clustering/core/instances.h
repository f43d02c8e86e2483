#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The objects of one scan.
struct Instances
{
  struct Object
  {
    std::uint32_t point_count = 0;
    ClassIndex class_index = kUnknownClass;  ///< of most of its points; the lower index wins a tie
    float x = 0.0F, y = 0.0F, z = 0.0F;      ///< mean of its points [m]
  };

  std::vector<std::uint32_t> id;  ///< a thing point's instance, parallel to ThingScan::points: 1..n, 0 for none
  std::vector<Object> objects;    ///< objects[i] is instance i + 1

  std::size_t count() const { return objects.size(); }
};

struct RefinementConfig
{
  int min_points = 1;  ///< smaller instances get id 0; 1 keeps all

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("min_points", self.min_points, 1, 10000);
  }
};

/// From a clusterer's components to numbered instances, in small steps; buffers are kept between scans.
class Refinement
{
public:
  explicit Refinement(RefinementConfig config) : config_(config) {}

  /// Ids are 1..n by the first pixel in row-major order. Linear in the thing points.
  void refine(const ThingScan& scan, const std::vector<std::uint32_t>& component, Instances& instances);

private:
  RefinementConfig config_;
  std::vector<std::uint32_t> size_of_, id_of_;  ///< by component
  std::vector<std::uint32_t> votes_;            ///< instance x class
};
}  // namespace lidar_panoptic_clustering
