#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The objects of one scan.
struct Instances
{
  /// One object.
  struct Object
  {
    std::uint32_t point_count = 0;           ///< its thing points
    ClassIndex class_index = kUnknownClass;  ///< of most of its points; the lower index wins a tie
    float x = 0.0F, y = 0.0F, z = 0.0F;      ///< mean of its points [m]
  };

  std::vector<std::uint32_t> id;  ///< a thing point's instance, parallel to ThingScan::points: 1..n, 0 for none
  std::vector<Object> objects;    ///< objects[i] is instance i + 1

  /// Number of objects, the largest id.
  std::size_t count() const { return objects.size(); }
};
}  // namespace lidar_panoptic_clustering
