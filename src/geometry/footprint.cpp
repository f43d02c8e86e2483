#include "lidar_panoptic_clustering/geometry/footprint.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
using Polygon = std::array<PlanarPoint, 8>;

/// Twice the area of triangle o a b, positive when it turns left.
double turn(const PlanarPoint& o, const PlanarPoint& a, const PlanarPoint& b)
{
  return (static_cast<double>(a.x) - o.x) * (static_cast<double>(b.y) - o.y) -
         (static_cast<double>(a.y) - o.y) * (static_cast<double>(b.x) - o.x);
}

/// The point of segment a b nearest to p.
PlanarPoint nearestOn(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& p)
{
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float squared = dx * dx + dy * dy;
  if (squared == 0.0F) return a;
  const float t = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0F, 1.0F);
  return {a.x + t * dx, a.y + t * dy};
}

/// Whether the segments a b and c d have a point in common other than by touching ends.
bool cross(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c, const PlanarPoint& d)
{
  return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

bool contains(const Polygon& polygon, int n, const PlanarPoint& p)
{
  if (n < 3) return false;
  for (int i = 0; i < n; ++i)
    if (turn(polygon[i], polygon[(i + 1) % n], p) < 0.0) return false;
  return true;
}
}  // namespace

int Footprint::corners(Polygon& polygon) const
{
  // counter-clockwise from +x: +x, +(x + y), +y, -(x - y), -x, -(x + y), -y, +(x - y)
  constexpr int kOrder[] = {0, 2, 1, 7, 4, 6, 5, 3};
  polygon[0] = point_[0];
  if (min_[0] == max_[0] && min_[1] == max_[1]) return 1;
  int n = 0;
  for (const int k : kOrder)
  {
    const PlanarPoint& p = point_[k];
    if (n > 0 && p.x == polygon[n - 1].x && p.y == polygon[n - 1].y) continue;
    polygon[n++] = p;
  }
  while (n > 1 && polygon[n - 1].x == polygon[0].x && polygon[n - 1].y == polygon[0].y) --n;
  return n;
}

RectangleSize Footprint::smallestRectangle() const
{
  Polygon polygon;
  const int n = corners(polygon);
  RectangleSize smallest;
  float least_area = kFar;
  for (int i = 0; i < n && n > 1; ++i)
  {
    const PlanarPoint &a = polygon[i], &b = polygon[(i + 1) % n];
    const float side = std::hypot(b.x - a.x, b.y - a.y);
    const float ux = (b.x - a.x) / side, uy = (b.y - a.y) / side;
    float along_min = kFar, along_max = -kFar, across_min = kFar, across_max = -kFar;
    for (int k = 0; k < n; ++k)
    {
      const float along = ux * (polygon[k].x - a.x) + uy * (polygon[k].y - a.y);
      const float across = ux * (polygon[k].y - a.y) - uy * (polygon[k].x - a.x);
      along_min = std::min(along_min, along), along_max = std::max(along_max, along);
      across_min = std::min(across_min, across), across_max = std::max(across_max, across);
    }
    const float length = along_max - along_min, width = across_max - across_min;
    if (!(length * width < least_area)) continue;
    least_area = length * width;
    smallest = {std::max(length, width), std::min(length, width)};
  }
  return smallest;
}

bool Footprint::fits(float length, float width) const
{
  // whatever its heading, a rectangle holds what lies within its inner circle
  const float dx = max_[0] - min_[0], dy = max_[1] - min_[1];
  if (dx * dx + dy * dy <= width * width) return true;
  const RectangleSize size = smallestRectangle();
  return size.length <= length && size.width <= width;
}

Footprint::Gap Footprint::gapTo(const Footprint& other) const
{
  Polygon mine, theirs;
  const int m = corners(mine), n = other.corners(theirs);
  Gap best{mine[0], theirs[0]};
  const auto consider = [&best](const PlanarPoint& from, const PlanarPoint& to)
  {
    const Gap gap{from, to};
    if (gap.squaredDistance() < best.squaredDistance()) best = gap;
  };
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j)
    {
      const PlanarPoint &a = mine[i], &b = mine[(i + 1) % m], &c = theirs[j], &d = theirs[(j + 1) % n];
      if (cross(a, b, c, d)) return {a, a};
      consider(nearestOn(a, b, c), c);
      consider(a, nearestOn(c, d, a));
    }
  if (contains(mine, m, theirs[0])) return {theirs[0], theirs[0]};
  if (contains(theirs, n, mine[0])) return {mine[0], mine[0]};
  return best;
}

bool Footprint::isCrossedBy(const PlanarPoint& a, const PlanarPoint& b) const
{
  Polygon polygon;
  const int n = corners(polygon);
  for (int i = 0; i < n && n > 1; ++i)
    if (cross(a, b, polygon[i], polygon[(i + 1) % n])) return true;
  return contains(polygon, n, a);
}
}  // namespace lidar_panoptic_clustering
