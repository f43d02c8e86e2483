#include "lidar_panoptic_clustering/geometry/cell_contents.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint64_t kFewPairs = 64;
constexpr float kFar = std::numeric_limits<float>::max();

float squaredDistance(float ax, float ay, float bx, float by)
{
  return (ax - bx) * (ax - bx) + (ay - by) * (ay - by);
}
}  // namespace

void CellContents::clear(std::size_t points)
{
  points_.resize(points);
  begin_.clear();
  place_.clear();
  looked_at_ = 0;
}

void CellContents::close()
{
  begin_.push_back(static_cast<std::uint32_t>(points_.size()));
  boxes_.assign(size(), {kFar, -kFar, kFar, -kFar});
  for (auto& flags : is_sorted_) flags.assign(size(), 0);
}

float CellContents::squaredGap(const Box& p, const Box& q)
{
  const float dx = std::max({0.0F, q.min_x - p.max_x, p.min_x - q.max_x});
  const float dy = std::max({0.0F, q.min_y - p.max_y, p.min_y - q.max_y});
  return dx * dx + dy * dy;
}

float CellContents::squaredSpan(const Box& p, const Box& q)
{
  const float dx = std::max(p.max_x, q.max_x) - std::min(p.min_x, q.min_x);
  const float dy = std::max(p.max_y, q.max_y) - std::min(p.min_y, q.min_y);
  return dx * dx + dy * dy;
}

bool CellContents::areCloser(Block a, Block b, float distance)
{
  const Range p = rangeOf(a), q = rangeOf(b);
  const float squared_distance = distance * distance;
  if (p.size() * q.size() <= kFewPairs) return isAnyPairCloser(p, q, squared_distance);
  if (a.end - a.begin == 1 && b.end - b.begin == 1) return areCellsCloser(a.begin, b.begin, distance);
  const Box box_a = boxOf(a), box_b = boxOf(b);
  if (squaredGap(box_a, box_b) >= squared_distance) return false;
  if (squaredSpan(box_a, box_b) < squared_distance) return true;
  for (std::uint32_t i = a.begin; i < a.end; ++i)
  {
    if (squaredGap(boxOf(i), box_b) >= squared_distance) continue;
    for (std::uint32_t j = b.begin; j < b.end; ++j)
      if (areCellsCloser(i, j, distance)) return true;
  }
  return false;
}

bool CellContents::areCellsCloser(std::uint32_t cell_a, std::uint32_t cell_b, float distance)
{
  const Range a = rangeOf({cell_a, cell_a + 1}), b = rangeOf({cell_b, cell_b + 1});
  const float squared_distance = distance * distance;
  if (a.size() * b.size() <= kFewPairs) return isAnyPairCloser(a, b, squared_distance);
  const Box &p = boxOf(cell_a), &q = boxOf(cell_b);
  if (squaredGap(p, q) >= squared_distance) return false;
  if (squaredSpan(p, q) < squared_distance) return true;
  if (isGreedyPairCloser(a, b, q, squared_distance)) return true;
  const Place &at_a = place_[cell_a], &at_b = place_[cell_b];
  const bool along_y = at_a.y == at_b.y;  // a line between the cells, parallel to this axis, parts their points
  const bool a_is_low = along_y ? at_a.x < at_b.x : at_a.y < at_b.y;
  return a_is_low ? reachesOver(cell_a, cell_b, along_y, distance) : reachesOver(cell_b, cell_a, along_y, distance);
}

bool CellContents::isAnyPairCloser(Range a, Range b, float squared_distance)
{
  looked_at_ += a.size() + b.size();
  for (std::uint32_t i = a.begin; i < a.end; ++i)
    for (std::uint32_t j = b.begin; j < b.end; ++j)
      if (squaredDistance(points_[i].x, points_[i].y, points_[j].x, points_[j].y) < squared_distance) return true;
  return false;
}

/// Looks where a close pair is likely: a's point nearest to the middle of b, b's nearest to that, and back once.
bool CellContents::isGreedyPairCloser(Range a, Range b, const Box& box_b, float squared_distance)
{
  const PlanarSample& from = nearest(a, 0.5F * (box_b.min_x + box_b.max_x), 0.5F * (box_b.min_y + box_b.max_y));
  const PlanarSample& to = nearest(b, from.x, from.y);
  if (squaredDistance(from.x, from.y, to.x, to.y) < squared_distance) return true;
  const PlanarSample& back = nearest(a, to.x, to.y);
  return squaredDistance(back.x, back.y, to.x, to.y) < squared_distance;
}

const PlanarSample& CellContents::nearest(Range range, float x, float y)
{
  looked_at_ += range.size();
  std::uint32_t best = range.begin;
  float least = kFar;
  for (std::uint32_t i = range.begin; i < range.end; ++i)
  {
    const float squared = squaredDistance(points_[i].x, points_[i].y, x, y);
    if (squared < least) least = squared, best = i;
  }
  return points_[best];
}

/// Whether a point of `high` lies in a disc about a point of `low`, where a line along x or y parts the two: then it
/// lies below the upper edge of all discs together (unit-spherical emptiness checking with line separation: Gan and
/// Tao, "DBSCAN Revisited", SIGMOD 2015, section 4). One sweep over both in order along the line.
bool CellContents::reachesOver(std::uint32_t low, std::uint32_t high, bool along_y, float distance)
{
  drawEnvelope(low, along_y, distance);
  const std::uint32_t count = begin_[high + 1] - begin_[high];
  looked_at_ += count;
  const PlanarSample* points = sorted(high, along_y);
  const double squared_distance = static_cast<double>(distance) * distance;
  std::size_t arc = 0;
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const double u = along_y ? points[i].y : points[i].x, v = along_y ? points[i].x : points[i].y;
    while (arc + 1 < envelope_.size() && envelope_[arc + 1].from <= u) ++arc;
    const double du = u - envelope_[arc].u, dv = v - envelope_[arc].v;
    if (du * du + dv * dv < squared_distance) return true;
  }
  return false;
}

/// The upper edge of the discs about the points of a cell: two of the same radius cross there once, so that a stack
/// finds it in one pass.
void CellContents::drawEnvelope(std::uint32_t cell, bool along_y, double distance)
{
  // where the edge of the disc about (u, v), right of arc a, rises above a's
  const auto crossing = [distance](const Arc& a, double u, double v)
  {
    const double du = u - a.u, dv = v - a.v;
    const double t = std::sqrt(distance * distance / (du * du + dv * dv) - 0.25);
    const double height = 0.5 * (a.v + v) + du * t;
    if (height < v) return u - distance;      // within the lower half of the new disc: above a wherever it is
    if (height < a.v) return a.u + distance;  // only where a has ended
    return 0.5 * (a.u + u) - dv * t;
  };
  const std::uint32_t count = begin_[cell + 1] - begin_[cell];
  looked_at_ += count;
  const PlanarSample* points = sorted(cell, along_y);
  envelope_.clear();
  for (std::uint32_t i = 0; i < count; ++i)
  {
    const double u = along_y ? points[i].y : points[i].x, v = along_y ? points[i].x : points[i].y;
    double from = -std::numeric_limits<double>::infinity();
    while (!envelope_.empty())
    {
      const Arc& last = envelope_.back();
      const double start = last.u < u ? crossing(last, u, v) : last.from;  // of two in a line the higher is left
      if (start > last.from)
      {
        from = start;
        break;
      }
      envelope_.pop_back();
    }
    envelope_.push_back({u, v, from});
  }
}

const CellContents::Box& CellContents::boxOf(std::uint32_t cell)
{
  Box& box = boxes_[cell];
  if (box.min_x <= box.max_x) return box;
  looked_at_ += begin_[cell + 1] - begin_[cell];
  for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i)
  {
    box.min_x = std::min(box.min_x, points_[i].x), box.max_x = std::max(box.max_x, points_[i].x);
    box.min_y = std::min(box.min_y, points_[i].y), box.max_y = std::max(box.max_y, points_[i].y);
  }
  return box;
}

CellContents::Box CellContents::boxOf(Block block)
{
  Box box = boxOf(block.begin);
  for (std::uint32_t cell = block.begin + 1; cell < block.end; ++cell)
  {
    const Box& other = boxOf(cell);
    box.min_x = std::min(box.min_x, other.min_x), box.max_x = std::max(box.max_x, other.max_x);
    box.min_y = std::min(box.min_y, other.min_y), box.max_y = std::max(box.max_y, other.max_y);
  }
  return box;
}

const PlanarSample* CellContents::sorted(std::uint32_t cell, bool along_y)
{
  std::vector<PlanarSample>& all = sorted_[along_y ? 1 : 0];
  if (all.size() < points_.size()) all.resize(points_.size());
  if (std::uint8_t& done = is_sorted_[along_y ? 1 : 0][cell]; done == 0)
  {
    std::copy(points_.begin() + begin_[cell], points_.begin() + begin_[cell + 1], all.begin() + begin_[cell]);
    const auto begin = all.begin() + begin_[cell], end = all.begin() + begin_[cell + 1];
    if (along_y)
      std::sort(begin, end,
                [](const PlanarSample& p, const PlanarSample& q) { return std::tie(p.y, p.x) < std::tie(q.y, q.x); });
    else
      std::sort(begin, end,
                [](const PlanarSample& p, const PlanarSample& q) { return std::tie(p.x, p.y) < std::tie(q.x, q.y); });
    done = 1;
  }
  return all.data() + begin_[cell];
}
}  // namespace lidar_panoptic_clustering
