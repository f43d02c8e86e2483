// Scan-line run point by point, for lines of many short runs.
#include "clusterers/scan_line_distance.h"
#include "lidar_panoptic_clustering/clusterers/scan_line_run_clusterer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kBlock = 8;

/// Of kBlock points: whether any is of another object than `object`, and any of these nearer to p than `distance`.
struct Others
{
  bool any, near;
};

template <class Point>
[[gnu::always_inline]] inline Others othersAmong(const Point& p, float distance, std::uint32_t object, const float* x,
                                                 const float* y, const float* z, const std::uint32_t* objects)
{
  using Floats = float __attribute__((vector_size(16)));
  using Ints = std::int32_t __attribute__((vector_size(16)));
  Ints any = {}, near = {};
  for (std::uint32_t k = 0; k < kBlock; k += 4)
  {
    Floats dx, dy, dz;
    Ints others;
    std::memcpy(&dx, x + k, sizeof(dx));
    std::memcpy(&dy, y + k, sizeof(dy));
    std::memcpy(&dz, z + k, sizeof(dz));
    std::memcpy(&others, objects + k, sizeof(others));
    dx -= p.x, dy -= p.y, dz -= p.z;
    const Ints is_other = others != static_cast<std::int32_t>(object);
    any |= is_other;
    near |= (dx * dx + dy * dy + dz * dz < distance * distance) & is_other;
  }
  const auto isAny = [](const Ints& mask)
  {
    std::uint64_t halves[2];
    std::memcpy(halves, &mask, sizeof(halves));
    return (halves[0] | halves[1]) != 0;
  };
  return {isAny(any), isAny(near)};
}

float horizontalRange(float x, float y)
{
  return std::sqrt(x * x + y * y);
}

/// What is far shares the last one.
std::uint32_t layerOf(float range, float layers_per_m)
{
  constexpr float kMostLayers = 1024.0F;
  return static_cast<std::uint32_t>(std::clamp(range * layers_per_m, 0.0F, kMostLayers));
}
}  // namespace

/// Each upper point with all lower ones in its window whose range is near its own.
void ScanLineRunClusterer::linkPoints(std::uint32_t upper_slot, std::uint32_t lower_slot, int turn)
{
  if (lower_.slot != lower_slot) sortByRange(lower_slot);
  for (std::uint32_t i = slot_begin_[upper_slot]; i < slot_begin_[upper_slot + 1]; ++i)
  {
    const Point& p = points_[i];
    linkPoint(p, 0);
    if (turn > 0 && p.column < p.window) linkPoint(p, -turn);
    if (turn > 0 && p.column + p.window >= turn) linkPoint(p, turn);
  }
}

/// Layers are half a distance thick, or where windows hold few points, which are compared as soon as a layer's are
/// found, one for all.
float ScanLineRunClusterer::layersPerMetre(std::uint32_t slot) const
{
  constexpr float kLayersInDistance = 2.0F;
  constexpr std::uint64_t kFew = 24;
  const std::uint32_t begin = slot_begin_[slot], end = slot_begin_[slot + 1];
  std::uint64_t window = 0;
  for (std::uint32_t i = begin; i < end; ++i) window += 2 * static_cast<std::uint64_t>(points_[i].window);
  return window < kFew * columns_ ? 0.0F : kLayersInDistance / line_distance_;
}

/// Puts a slot's points into layers of about the same range: two points are no nearer than their ranges differ.
void ScanLineRunClusterer::sortByRange(std::uint32_t slot)
{
  const std::uint32_t begin = slot_begin_[slot], size = slot_begin_[slot + 1] - begin;
  layer_of_point_.resize(size);
  layer_begin_.assign(1, 0);
  lower_.layers_per_m = layersPerMetre(slot);
  for (std::uint32_t k = 0; k < size; ++k)
  {
    const Point& q = points_[begin + k];
    const std::uint32_t layer = layer_of_point_[k] = layerOf(horizontalRange(q.x, q.y), lower_.layers_per_m);
    if (layer + 2 > layer_begin_.size()) layer_begin_.resize(layer + 2, 0);
    ++layer_begin_[layer + 1];
  }
  lower_.slot = slot;
  lower_.layers.clear();
  constexpr float kFar = std::numeric_limits<float>::infinity();
  for (std::size_t layer = 0; layer + 1 < layer_begin_.size(); ++layer)
  {
    layer_begin_[layer + 1] += layer_begin_[layer];
    const std::uint32_t at = layer_begin_[layer];
    lower_.layers.push_back({at, at, kFar, -kFar, kFar, -kFar, at, at, at, at});
  }
  for (auto* coordinate : {&lower_.x, &lower_.y, &lower_.z})
    coordinate->assign(size + kBlock, kFar);  // see linkLayer()
  lower_.object.resize(size + kBlock);
  lower_.column.resize(size);
  lower_.point.resize(size);
  for (std::uint32_t k = 0; k < size; ++k)
  {
    const Point& q = points_[begin + k];
    Layer& layer = lower_.layers[layer_of_point_[k]];
    const std::uint32_t to = layer.end++;
    const float range = horizontalRange(q.x, q.y);
    layer.min_range = std::min(layer.min_range, range), layer.max_range = std::max(layer.max_range, range);
    layer.min_z = std::min(layer.min_z, q.z), layer.max_z = std::max(layer.max_z, q.z);
    lower_.x[to] = q.x, lower_.y[to] = q.y, lower_.z[to] = q.z;
    lower_.object[to] = sets_.find(run_of_thing_[q.thing]);
    lower_.column[to] = q.column;
    lower_.point[to] = begin + k;
  }
}

void ScanLineRunClusterer::linkPoint(const Point& p, int shift)
{
  constexpr float kRounding = 1.0001F, kRangeRounding = 1e-5F;  // no layer is to be left out that holds a close point
  const float distance = kRounding * std::min(line_distance_, p.link_distance);
  const float range = horizontalRange(p.x, p.y), slack = kRangeRounding * range;
  std::uint32_t object = sets_.find(run_of_thing_[p.thing]);
  const std::size_t end =
      std::min<std::size_t>(layerOf(range + distance + slack, lower_.layers_per_m) + 1, lower_.layers.size());
  for (std::size_t k = layerOf(range - distance - slack, lower_.layers_per_m); k < end; ++k)
  {
    Layer& layer = lower_.layers[k];
    if (layer.begin == layer.end) continue;
    const float along = std::max({0.0F, layer.min_range - range - slack, range - layer.max_range - slack});
    const float up = std::max({0.0F, layer.min_z - p.z, p.z - layer.max_z});
    if (along * along + up * up < distance * distance) linkLayer(p, shift, layer, object);
  }
}

/// Joins p with the close ones of a layer; `object` is that of p. Those known to be of one object are passed over where
/// it is p's.
void ScanLineRunClusterer::linkLayer(const Point& p, int shift, Layer& layer, std::uint32_t& object)
{
  const int left = p.column - p.window - shift, right = p.column + p.window + 1 - shift;
  std::uint32_t from = layer.from, to = layer.to;
  if (shift == 0)  // from one point of the upper line to the next the window moves on by a few
  {
    from = layer.from = moveTo(left, layer, from);
    to = layer.to = moveTo(right, layer, to);
  }
  else
  {
    const auto columns = lower_.column.begin();
    from = static_cast<std::uint32_t>(std::lower_bound(columns + layer.begin, columns + layer.end, left) - columns);
    to = static_cast<std::uint32_t>(std::lower_bound(columns + from, columns + layer.end, right) - columns);
  }
  if (from == to) return;
  const std::uint32_t begin = std::max(from, layer.same_begin), end = std::min(to, layer.same_end);
  const bool is_beside = layer.same_begin < layer.same_end && begin <= end;  // or among them
  const bool is_known =
      is_beside && (sets_.find(lower_.object[layer.same_begin]) == object || joinAny(p, shift, begin, end, object));
  Stretch same(is_known ? std::min(from, layer.same_begin) : from);
  if (is_beside)
  {
    linkRange(p, shift, from, begin, object, same);
    same.add(is_known ? layer.same_end : end, is_known);
    linkRange(p, shift, end, to, object, same);
  }
  else
  {
    linkRange(p, shift, from, to, object, same);
  }
  const bool is_longer = same.longestEnd() - same.longestBegin() > layer.same_end - layer.same_begin;
  if (is_beside && !is_longer) return;
  layer.same_begin = same.longestBegin(), layer.same_end = same.longestEnd();
}

/// Joins p with the points [begin, end) of lower_, which are known to be of one object: a close one will do, looked for
/// from the middle on, where p is. Whether there is one.
bool ScanLineRunClusterer::joinAny(const Point& p, int shift, std::uint32_t begin, std::uint32_t end,
                                   std::uint32_t& object)
{
  const float distance = std::min(line_distance_, p.link_distance);
  const std::uint32_t middle = begin + (end - begin) / 2;
  const auto joins = [&](std::uint32_t from, std::uint32_t to)
  {
    for (std::uint32_t k = from; k < to; k += kBlock)
    {
      looked_at_ += kBlock;
      if (!othersAmong(p, distance, object, &lower_.x[k], &lower_.y[k], &lower_.z[k], &lower_.object[k]).near) continue;
      linkBlock(p, shift, k, std::min(k + kBlock, to), object);
      if (sets_.find(lower_.object[begin]) == object) return true;
    }
    return false;
  };
  return joins(middle, end) || joins(begin, middle);
}

/// The first point of a layer at or right of `column`, looked for from point `k` on, either way.
std::uint32_t ScanLineRunClusterer::moveTo(int column, const Layer& layer, std::uint32_t k) const
{
  while (k > layer.begin && lower_.column[k - 1] >= column) --k;
  while (k < layer.end && lower_.column[k] < column) ++k;
  return k;
}

/// Joins p with the close ones among [from, to) of lower_, and adds to `same` which of these are known to be of p's
/// object then. A block may end behind the line: what stands there is infinitely far.
void ScanLineRunClusterer::linkRange(const Point& p, int shift, std::uint32_t from, std::uint32_t to,
                                     std::uint32_t& object, Stretch& same)
{
  const float distance = std::min(line_distance_, p.link_distance);
  for (std::uint32_t k = from; k < to; k += kBlock)
  {
    looked_at_ += kBlock;
    const std::uint32_t end = std::min(k + kBlock, to);
    const Others others = othersAmong(p, distance, object, &lower_.x[k], &lower_.y[k], &lower_.z[k], &lower_.object[k]);
    const bool is_looked_at = others.near || (others.any && k + kBlock > to);
    same.add(end, is_looked_at ? linkBlock(p, shift, k, end, object) : !others.any);
  }
}

/// The same for points [begin, end) of one block, one after the other.
bool ScanLineRunClusterer::linkBlock(const Point& p, int shift, std::uint32_t begin, std::uint32_t end,
                                     std::uint32_t& object)
{
  bool all = true;
  for (std::uint32_t k = begin; k < end; ++k)
  {
    if (lower_.object[k] == object) continue;
    const Point& q = points_[lower_.point[k]];
    if (std::abs(q.column + shift - p.column) > q.window || !areClose(p, q, line_distance_))
    {
      all = false;
      continue;
    }
    sets_.unite(object, run_of_thing_[q.thing]);
    object = lower_.object[k] = sets_.find(object);
  }
  return all;
}
}  // namespace lidar_panoptic_clustering
