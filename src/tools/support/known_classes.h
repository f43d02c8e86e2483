#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Throws std::runtime_error naming `file`, the point and its id when a label's class is not in the table.
inline void requireKnownClasses(const std::vector<std::uint32_t>& labels, const ClassTable& table,
                                const std::string& file)
{
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (table.find(rawClass(labels[i])) == kUnknownClass)
      throw std::runtime_error(file + ": point " + std::to_string(i) + " has class id " +
                               std::to_string(rawClass(labels[i])) + ", which is not in class table '" + table.name() +
                               "'");
}
}  // namespace lidar_panoptic_clustering
