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

/// The upright rectangle about a side.
struct Extent
{
  float min_x, max_x, min_y, max_y;
  /// [m^2]
  float squaredGapTo(const Extent& other) const
  {
    const float dx = std::max({0.0F, other.min_x - max_x, min_x - other.max_x});
    const float dy = std::max({0.0F, other.min_y - max_y, min_y - other.max_y});
    return dx * dx + dy * dy;
  }
};

/// Of the polygon's sides.
void findExtents(const Polygon& polygon, int n, std::array<Extent, 8>& extents)
{
  for (int i = 0; i < n; ++i)
  {
    const PlanarPoint &a = polygon[i], &b = polygon[i + 1 < n ? i + 1 : 0];
    extents[i] = {std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y)};
  }
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
  if (isPoint()) return 1;
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

bool Footprint::fitsWith(const Footprint& other, float length, float width) const
{
  const auto extent = [&](int k) { return std::max(max_[k], other.max_[k]) - std::min(min_[k], other.min_[k]); };
  const float dx = extent(0), dy = extent(1);
  if (dx * dx + dy * dy <= width * width) return true;  // see fits()
  // no rectangle is longer in any direction than its diagonal; the diagonals' unit is 1 / sqrt(2) m
  constexpr float kRounding = 1.001F;
  const float most = kRounding * (length * length + width * width);
  const float along = extent(2), against = extent(3);
  if (dx * dx > most || dy * dy > most || along * along > 2.0F * most || against * against > 2.0F * most) return false;
  Footprint both = *this;
  both.add(other);
  const RectangleSize size = both.smallestRectangle();
  return size.length <= length && size.width <= width;
}

/// Sides whose extents are farther apart than what was found are passed over, and where the outlines' extents part
/// them, none can cross.
Footprint::Gap Footprint::gapTo(const Footprint& other) const
{
  constexpr float kParted = 1e-3F, kRounding = 1e-3F;  // [m], and of the squared distance and of 1 m^2
  Polygon mine, theirs;
  const int m = corners(mine), n = other.corners(theirs);
  Gap best{mine[0], theirs[0]};
  if (m == 1 && n == 1) return best;
  std::array<Extent, 8> my_extents, their_extents;
  findExtents(mine, m, my_extents);
  findExtents(theirs, n, their_extents);
  const bool may_meet = mayBeCloser(other, kParted);
  float least = best.squaredDistance();
  const auto consider = [&](const PlanarPoint& from, const PlanarPoint& to)
  {
    const Gap gap{from, to};
    if (const float squared = gap.squaredDistance(); squared < least) best = gap, least = squared;
  };
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j)
    {
      const float squared_gap = my_extents[i].squaredGapTo(their_extents[j]);
      if (squared_gap > least + kRounding * (least + 1.0F)) continue;
      const PlanarPoint &a = mine[i], &b = mine[i + 1 < m ? i + 1 : 0], &c = theirs[j],
                        &d = theirs[j + 1 < n ? j + 1 : 0];
      if (may_meet && squared_gap == 0.0F && cross(a, b, c, d)) return {a, a};
      consider(nearestOn(a, b, c), c);
      consider(a, nearestOn(c, d, a));
    }
  if (contains(mine, m, theirs[0])) return {theirs[0], theirs[0]};
  if (contains(theirs, n, mine[0])) return {mine[0], mine[0]};
  return best;
}

/// What lies beside the outline does not cross it; one as thin as a line holds, by rounding, what lies in its line.
bool Footprint::isBeside(const PlanarPoint& a, const PlanarPoint& b) const
{
  constexpr float kParted = 1e-3F;  // [m]
  const float from[kAxes] = {a.x, a.y, a.x + a.y, a.x - a.y}, to[kAxes] = {b.x, b.y, b.x + b.y, b.x - b.y};
  bool beside = false;
  for (int k = 0; k < kAxes; ++k)
  {
    if (max_[k] - min_[k] < kParted) return false;
    beside = beside || std::min(from[k], to[k]) - max_[k] > kParted || min_[k] - std::max(from[k], to[k]) > kParted;
  }
  return beside;
}

bool Footprint::isCrossedBy(const PlanarPoint& a, const PlanarPoint& b) const
{
  if (isPoint() || isBeside(a, b)) return false;
  Polygon polygon;
  const int n = corners(polygon);
  for (int i = 0; i < n && n > 1; ++i)
    if (cross(a, b, polygon[i], polygon[(i + 1) % n])) return true;
  return contains(polygon, n, a);
}
}  // namespace lidar_panoptic_clustering
