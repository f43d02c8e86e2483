#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstddef>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Makes room for `count` values, and for as many again where there is too little: std::vector::assign() and copies
/// take just what they need, so that a list that becomes one longer from scan to scan asks for memory each time.
template <class Value>
void makeRoom(std::vector<Value>& values, std::size_t count)
{
  if (count > values.capacity()) values.reserve(2 * count);
}
}  // namespace lidar_panoptic_clustering
