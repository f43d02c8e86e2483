#include "lidar_panoptic_clustering/geometry/planar_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kSideInDiagonals = 0.7071F;  // below sqrt(1/2): two points of a cell are closer than its diagonal
constexpr std::uint64_t kFewPairs = 64;
constexpr float kFar = std::numeric_limits<float>::max();

/// In order of layer, y and x: one more is the next cell along x, kRowStep more the one beside it along y.
constexpr std::uint64_t kRowStep = 1U << 28U;
std::uint64_t placeOf(const PlanarKey& key)
{
  constexpr std::int64_t kMiddle = 1 << 27;
  return (static_cast<std::uint64_t>(key.layer) << 56U) + (static_cast<std::uint64_t>(key.y + kMiddle) << 28U) +
         static_cast<std::uint64_t>(key.x + kMiddle);
}

/// std::floor is a call to the C library on processors without SSE 4.1.
std::int32_t floorToInt(float value)
{
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (value < static_cast<float>(truncated) ? 1 : 0);
}

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
float squaredDistance(float ax, float ay, float bx, float by)
{
  return (ax - bx) * (ax - bx) + (ay - by) * (ay - by);
}
}  // namespace

void PlanarCells::clear(std::size_t capacity)
{
  index_.reset(index_.size());  // about as many as in the last scan
  ranges_.clear();
  added_.clear();
  added_.reserve(capacity);
  cell_of_added_.clear();
  cell_of_added_.reserve(capacity);
  last_cell_ = kNone;
  looked_at_ = 0;
}

void PlanarCells::add(float x, float y, std::int32_t layer, float distance, std::uint32_t thing)
{
  if (distance != last_distance_)
  {
    last_distance_ = distance;
    cells_per_m_ = 1.0F / (kSideInDiagonals * distance);
  }
  const PlanarKey key{floorToInt(x * cells_per_m_), floorToInt(y * cells_per_m_), layer};
  // neighbours in the scan mostly share a cell
  if (last_cell_ == kNone || key.x != last_key_.x || key.y != last_key_.y || key.layer != last_key_.layer)
  {
    last_cell_ = index_.insert(key);
    last_key_ = key;
    if (last_cell_ == ranges_.size()) ranges_.push_back({0, 0});
  }
  ++ranges_[last_cell_].end;
  added_.push_back({x, y, thing});
  cell_of_added_.push_back(last_cell_);
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
  boxes_.assign(size(), {kFar, -kFar, kFar, -kFar});
  for (auto& flags : is_sorted_) flags.assign(size(), 0);
}

void PlanarCells::findComponents(const std::vector<float>& distance_of_layer,
                                 std::vector<std::uint32_t>& component_of_cell)
{
  places_.clear();
  for (std::uint32_t cell = 0; cell < size(); ++cell) places_.push_back({placeOf(index_[cell]), cell});
  std::sort(places_.begin(), places_.end(), [](const Place& p, const Place& q) { return p.place < q.place; });
  sets_.reset(size());
  joinNeighbours(distance_of_layer, 1);  // first, so that most pairs farther apart are joined before their turn
  joinNeighbours(distance_of_layer, kReach);
  sets_.flatten(component_of_cell);
}

/// Joins each cell with those at just `reach` along x or y (at 1 to `reach` for 1): half of them, the other half looks
/// here. One sweep over all rows with a finger in each row above.
void PlanarCells::joinNeighbours(const std::vector<float>& distance_of_layer, int reach)
{
  std::array<std::size_t, kReach + 1> finger{};
  const auto far = static_cast<std::uint64_t>(reach);
  for (const auto& [place, cell] : places_)
    for (int dy = 0; dy <= reach; ++dy)
    {
      const std::uint64_t above = place + static_cast<std::uint64_t>(dy) * kRowStep;
      const std::uint64_t first = dy == 0 ? above + 1 : above - far;
      std::size_t& k = finger[static_cast<std::size_t>(dy)];
      while (k < places_.size() && places_[k].place < first) ++k;
      for (std::size_t n = k; n < places_.size() && places_[n].place <= above + far; ++n)
      {
        const std::uint32_t other = places_[n].cell;
        const bool is_new = reach == 1 || dy == reach || places_[n].place + far == above ||
                            places_[n].place == above + far;  // not beside it
        if (is_new && sets_.find(cell) != sets_.find(other) &&
            areCloser(cell, other, distance_of_layer[static_cast<std::size_t>(index_[cell].layer)]))
          sets_.unite(cell, other);
      }
    }
}

bool PlanarCells::areCloser(std::uint32_t cell_a, std::uint32_t cell_b, float distance)
{
  const PlanarKey &key_a = index_[cell_a], &key_b = index_[cell_b];
  if (key_a.x == key_b.x && key_a.y == key_b.y) return true;
  const Range a = ranges_[cell_a], b = ranges_[cell_b];
  const float squared_distance = distance * distance;
  if ((a.end - a.begin) * static_cast<std::uint64_t>(b.end - b.begin) <= kFewPairs)
    return isAnyPairCloser(a, b, squared_distance);

  const Box &p = boxOf(cell_a), &q = boxOf(cell_b);
  if (squaredGap(p.min_x, p.max_x, q.min_x, q.max_x) + squaredGap(p.min_y, p.max_y, q.min_y, q.max_y) >=
      squared_distance)
    return false;
  if (squaredSpan(p.min_x, p.max_x, q.min_x, q.max_x) + squaredSpan(p.min_y, p.max_y, q.min_y, q.max_y) <
      squared_distance)
    return true;
  if (isGreedyPairCloser(a, b, q, squared_distance)) return true;
  const bool along_y = key_a.y == key_b.y;  // a line between the cells, parallel to this axis, parts their points
  const bool a_is_low = along_y ? key_a.x < key_b.x : key_a.y < key_b.y;
  return a_is_low ? reachesOver(cell_a, cell_b, along_y, distance) : reachesOver(cell_b, cell_a, along_y, distance);
}

bool PlanarCells::isAnyPairCloser(Range a, Range b, float squared_distance)
{
  looked_at_ += (a.end - a.begin) + (b.end - b.begin);
  for (std::uint32_t i = a.begin; i < a.end; ++i)
    for (std::uint32_t j = b.begin; j < b.end; ++j)
      if (squaredDistance(points_[i].x, points_[i].y, points_[j].x, points_[j].y) < squared_distance) return true;
  return false;
}

/// Looks where a close pair is likely: a's point nearest to the middle of b, b's nearest to that, and back once.
bool PlanarCells::isGreedyPairCloser(Range a, Range b, const Box& box_b, float squared_distance)
{
  const Point& from = nearest(a, 0.5F * (box_b.min_x + box_b.max_x), 0.5F * (box_b.min_y + box_b.max_y));
  const Point& to = nearest(b, from.x, from.y);
  if (squaredDistance(from.x, from.y, to.x, to.y) < squared_distance) return true;
  const Point& back = nearest(a, to.x, to.y);
  return squaredDistance(back.x, back.y, to.x, to.y) < squared_distance;
}

const PlanarCells::Point& PlanarCells::nearest(Range range, float x, float y)
{
  looked_at_ += range.end - range.begin;
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
bool PlanarCells::reachesOver(std::uint32_t low, std::uint32_t high, bool along_y, float distance)
{
  drawEnvelope(low, along_y, distance);
  const std::uint32_t count = ranges_[high].end - ranges_[high].begin;
  looked_at_ += count;
  const Point* points = sorted(high, along_y);
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
void PlanarCells::drawEnvelope(std::uint32_t cell, bool along_y, double distance)
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
  const std::uint32_t count = ranges_[cell].end - ranges_[cell].begin;
  looked_at_ += count;
  const Point* points = sorted(cell, along_y);
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

const PlanarCells::Box& PlanarCells::boxOf(std::uint32_t cell)
{
  Box& box = boxes_[cell];
  if (box.min_x <= box.max_x) return box;
  looked_at_ += ranges_[cell].end - ranges_[cell].begin;
  for (std::uint32_t i = ranges_[cell].begin; i < ranges_[cell].end; ++i)
  {
    box.min_x = std::min(box.min_x, points_[i].x), box.max_x = std::max(box.max_x, points_[i].x);
    box.min_y = std::min(box.min_y, points_[i].y), box.max_y = std::max(box.max_y, points_[i].y);
  }
  return box;
}

const PlanarCells::Point* PlanarCells::sorted(std::uint32_t cell, bool along_y)
{
  std::vector<Point>& all = sorted_[along_y ? 1 : 0];
  if (all.size() < points_.size()) all.resize(points_.size());
  const Range range = ranges_[cell];
  if (std::uint8_t& done = is_sorted_[along_y ? 1 : 0][cell]; done == 0)
  {
    std::copy(points_.begin() + range.begin, points_.begin() + range.end, all.begin() + range.begin);
    const auto begin = all.begin() + range.begin, end = all.begin() + range.end;
    if (along_y)
      std::sort(begin, end, [](const Point& p, const Point& q) { return std::tie(p.y, p.x) < std::tie(q.y, q.x); });
    else
      std::sort(begin, end, [](const Point& p, const Point& q) { return std::tie(p.x, p.y) < std::tie(q.x, q.y); });
    done = 1;
  }
  return all.data() + range.begin;
}
}  // namespace lidar_panoptic_clustering
