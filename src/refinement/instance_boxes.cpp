#include "lidar_panoptic_clustering/refinement/instance_boxes.h"

#include "core/make_room.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265F;

/// Twice the area of triangle o a b, positive when it turns left. In double: the points may lie far out.
template <class P>
double turn(const P& o, const P& a, const P& b)
{
  return (static_cast<double>(a.x) - o.x) * (static_cast<double>(b.y) - o.y) -
         (static_cast<double>(a.y) - o.y) * (static_cast<double>(b.x) - o.x);
}
}  // namespace

const std::vector<InstanceBox>& InstanceBoxes::fit(const ThingScan& scan, const Instances& instances)
{
  groupByInstance(scan, instances);
  for (std::size_t k = 0; k < instances.count(); ++k)
  {
    findHull(points_.data() + begin_[k], points_.data() + begin_[k + 1]);
    fitRectangle(boxes_[k]);
  }
  return boxes_;
}

void InstanceBoxes::groupByInstance(const ThingScan& scan, const Instances& instances)
{
  makeRoom(begin_, instances.count() + 1), makeRoom(next_, instances.count() + 1), makeRoom(boxes_, instances.count());
  begin_.assign(instances.count() + 1, 0);
  for (std::size_t k = 0; k < instances.count(); ++k) begin_[k + 1] = begin_[k] + instances.objects[k].point_count;
  next_.assign(begin_.begin(), begin_.end());
  points_.resize(begin_.back());

  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  boxes_.assign(instances.count(), InstanceBox());
  for (auto& box : boxes_) box.z = kInfinity, box.height = -kInfinity;  // lowest and highest, for the time being
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    if (instances.id[i] == 0) continue;
    const std::uint32_t k = instances.id[i] - 1;
    const ThingPoint& p = scan.points[i];
    points_[next_[k]++] = {p.x, p.y};
    boxes_[k].z = std::min(boxes_[k].z, p.z);
    boxes_[k].height = std::max(boxes_[k].height, p.z);
  }
  for (auto& box : boxes_)
  {
    const float low = box.z, high = box.height;
    box.z = 0.5F * (low + high), box.height = high - low;
  }
}

/// Moves the points that may be corners of the hull to the front, and returns their end: those that do not lie inside
/// of the polygon of the farthest ones in eight directions, by more than what rounding may make of them.
InstanceBoxes::Point* InstanceBoxes::dropInside(Point* begin, Point* end)
{
  constexpr std::ptrdiff_t kFewest = 24;  // below, sorting is as quick
  if (end - begin < kFewest) return end;
  Footprint outline;
  for (const Point* p = begin; p != end; ++p) outline.add(p->x, p->y);
  std::array<PlanarPoint, 2 * Footprint::kAxes> corner;
  const int n = outline.corners(corner);
  if (n < 3) return end;
  struct Side
  {
    float x, y, dx, dy;
  };
  std::array<Side, 2 * Footprint::kAxes> sides;
  for (int k = 0; k < n; ++k)
  {
    const PlanarPoint &a = corner[k], &b = corner[(k + 1) % n];
    sides[k] = {a.x, a.y, b.x - a.x, b.y - a.y};
  }
  const float extent = outline.maxX() - outline.minX() + outline.maxY() - outline.minY();
  const float margin = 1e-6F * extent * extent;  // four times the error of the products
  return std::remove_if(begin, end,
                        [&](const Point& p)
                        {
                          for (int k = 0; k < n; ++k)
                            if (!(sides[k].dx * (p.y - sides[k].y) - sides[k].dy * (p.x - sides[k].x) > margin))
                              return false;
                          return true;
                        });
}

/// Andrew's monotone chain.
void InstanceBoxes::findHull(Point* begin, Point* end)
{
  end = dropInside(begin, end);
  std::sort(begin, end);
  hull_.clear();
  const auto add = [this](const Point& p, std::size_t kept)
  {
    while (hull_.size() >= kept + 2 && turn(hull_[hull_.size() - 2], hull_.back(), p) <= 0.0) hull_.pop_back();
    hull_.push_back(p);
  };
  for (const Point* p = begin; p != end; ++p) add(*p, 0);
  const std::size_t lower = hull_.size() - 1;
  for (const Point* p = end - 1; p != begin;) add(*--p, lower);
  if (hull_.size() > 1) hull_.pop_back();  // the first point again
}

/// Rotating calipers: as the side turns, the extreme points along it and across it move on in the same sense.
void InstanceBoxes::fitRectangle(InstanceBox& box) const
{
  const std::size_t n = hull_.size();
  box.x = hull_[0].x, box.y = hull_[0].y;
  double least_area = std::numeric_limits<double>::infinity();
  std::size_t front = 0, far = 0, back = 0;
  for (std::size_t i = 0; i < n && n > 1; ++i)
  {
    const Point &a = hull_[i], &b = hull_[(i + 1) % n];
    double ux = static_cast<double>(b.x) - a.x, uy = static_cast<double>(b.y) - a.y;
    const double side = std::hypot(ux, uy);
    if (side == 0.0) continue;
    ux /= side, uy /= side;
    const auto along = [&](std::size_t k) { return ux * (hull_[k % n].x - a.x) + uy * (hull_[k % n].y - a.y); };
    const auto across = [&](std::size_t k) { return ux * (hull_[k % n].y - a.y) - uy * (hull_[k % n].x - a.x); };
    const auto climb = [n](std::size_t from, std::size_t at_least, const auto& height)
    {
      from = std::max(from, at_least);
      for (std::size_t steps = 0; steps < n && height(from + 1) >= height(from); ++steps) ++from;
      return from;
    };
    front = climb(front, i, along);
    far = climb(far, front, across);
    back = climb(back, far, [&](std::size_t k) { return -along(k); });

    const double min = along(back), max = along(front), depth = across(far);
    if (!((max - min) * depth < least_area)) continue;
    least_area = (max - min) * depth;
    const double middle = 0.5 * (min + max);
    box.x = static_cast<float>(a.x + ux * middle - uy * 0.5 * depth);
    box.y = static_cast<float>(a.y + uy * middle + ux * 0.5 * depth);
    box.length = static_cast<float>(max - min), box.width = static_cast<float>(depth);
    box.yaw = static_cast<float>(std::atan2(uy, ux));
  }
  if (box.width > box.length) std::swap(box.width, box.length), box.yaw += 0.5F * kPi;
  while (box.yaw > 0.5F * kPi) box.yaw -= kPi;
  while (box.yaw <= -0.5F * kPi) box.yaw += kPi;
}
}  // namespace lidar_panoptic_clustering
