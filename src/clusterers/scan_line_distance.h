#pragma once

#include <algorithm>

namespace lidar_panoptic_clustering
{
/// [m^2]
template <class A, class B>
float squaredDistance(const A& a, const B& b)
{
  const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  return dx * dx + dy * dy + dz * dz;
}

/// Whether two points are closer than `limit` and than both classes' link distance.
template <class Point>
bool areClose(const Point& a, const Point& b, float limit)
{
  const float distance = std::min({limit, a.link_distance, b.link_distance});
  return squaredDistance(a, b) < distance * distance;
}
}  // namespace lidar_panoptic_clustering
