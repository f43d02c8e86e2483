#include "lidar_panoptic_clustering/core/planar_cells.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kSideInDiagonals = 0.7071F;  // below sqrt(1/2): two points of a cell are closer than its diagonal
constexpr std::uint64_t kFewPairs = 64;

float squaredGap(float a_min, float a_max, float b_min, float b_max)
{
  const float gap = std::max({0.0F, b_min - a_max, a_min - b_max});
  return gap * gap;
}
float squaredSpan(float a_min, float a_max, float b_min, float b_max)
{
  const float span = std::max(a_max, b_max) - std::min(a_min, b_min);
  return span * span;
}
}  // namespace

void PlanarCells::clear(std::size_t capacity)
{
  index_.reset(capacity);
  ranges_.clear();
  added_.clear();
  cell_of_added_.clear();
  looked_at_ = 0;
}

void PlanarCells::add(float x, float y, std::int32_t layer, float distance, std::uint32_t thing)
{
  const float cells_per_m = 1.0F / (kSideInDiagonals * distance);
  const std::uint32_t cell = index_.insert({static_cast<std::int32_t>(std::floor(x * cells_per_m)),
                                            static_cast<std::int32_t>(std::floor(y * cells_per_m)), layer});
  if (cell == ranges_.size()) ranges_.push_back({0, 0});
  ++ranges_[cell].end;
  added_.push_back({x, y, thing});
  cell_of_added_.push_back(cell);
}

void PlanarCells::close()
{
  std::uint32_t begin = 0;
  for (Range& range : ranges_)
  {
    const std::uint32_t size = range.end;
    range = {begin, begin};
    begin += size;
  }
  points_.resize(added_.size());
  for (std::size_t i = 0; i < added_.size(); ++i) points_[ranges_[cell_of_added_[i]].end++] = added_[i];
}

void PlanarCells::findComponents(const std::vector<float>& distance_of_layer,
                                 std::vector<std::uint32_t>& component_of_cell)
{
  sets_.reset(size());
  for (std::uint32_t cell = 0; cell < size(); ++cell)
  {
    const VoxelKey key = index_[cell];
    const float distance = distance_of_layer[static_cast<std::size_t>(key.z)];
    for (int dy = 0; dy <= kReach; ++dy)  // half of the cells around: the other half looks here
      for (int dx = dy == 0 ? 1 : -kReach; dx <= kReach; ++dx)
      {
        const std::uint32_t other = index_.find({key.x + dx, key.y + dy, key.z});
        if (other != kNone && sets_.find(cell) != sets_.find(other) && areCloser(cell, other, distance))
          sets_.unite(cell, other);
      }
  }
  sets_.flatten(component_of_cell);
}

bool PlanarCells::areCloser(std::uint32_t cell_a, std::uint32_t cell_b, float distance)
{
  return anyCloser(ranges_[cell_a], ranges_[cell_b], distance * distance);
}

bool PlanarCells::anyCloser(Range a, Range b, float squared_distance)
{
  const std::uint32_t size_a = a.end - a.begin, size_b = b.end - b.begin;
  looked_at_ += size_a + size_b;
  if (size_a * static_cast<std::uint64_t>(size_b) <= kFewPairs)
  {
    for (std::uint32_t i = a.begin; i < a.end; ++i)
      for (std::uint32_t j = b.begin; j < b.end; ++j)
      {
        const float dx = points_[i].x - points_[j].x, dy = points_[i].y - points_[j].y;
        if (dx * dx + dy * dy < squared_distance) return true;
      }
    return false;
  }
  const Box p = boxOf(a), q = boxOf(b);
  if (squaredGap(p.min_x, p.max_x, q.min_x, q.max_x) + squaredGap(p.min_y, p.max_y, q.min_y, q.max_y) >=
      squared_distance)
    return false;
  if (squaredSpan(p.min_x, p.max_x, q.min_x, q.max_x) + squaredSpan(p.min_y, p.max_y, q.min_y, q.max_y) <
      squared_distance)
    return true;
  if (size_a >= size_b)
  {
    const Range rest = halve(a, p);
    return anyCloser(a, b, squared_distance) || anyCloser(rest, b, squared_distance);
  }
  const Range rest = halve(b, q);
  return anyCloser(a, b, squared_distance) || anyCloser(a, rest, squared_distance);
}

PlanarCells::Box PlanarCells::boxOf(Range range) const
{
  const Point& first = points_[range.begin];
  Box box{first.x, first.x, first.y, first.y};
  for (std::uint32_t i = range.begin + 1; i < range.end; ++i)
  {
    box.min_x = std::min(box.min_x, points_[i].x), box.max_x = std::max(box.max_x, points_[i].x);
    box.min_y = std::min(box.min_y, points_[i].y), box.max_y = std::max(box.max_y, points_[i].y);
  }
  return box;
}

/// Sorts the range's points to either side of the median along its box's longer side; returns the upper half.
PlanarCells::Range PlanarCells::halve(Range& range, const Box& box)
{
  const auto begin = points_.begin() + range.begin, end = points_.begin() + range.end;
  const auto middle = begin + (range.end - range.begin) / 2;
  if (box.max_x - box.min_x > box.max_y - box.min_y)
    std::nth_element(begin, middle, end, [](const Point& p, const Point& q) { return p.x < q.x; });
  else
    std::nth_element(begin, middle, end, [](const Point& p, const Point& q) { return p.y < q.y; });
  const auto split = static_cast<std::uint32_t>(middle - points_.begin());
  const Range upper{split, range.end};
  range.end = split;
  return upper;
}
}  // namespace lidar_panoptic_clustering
