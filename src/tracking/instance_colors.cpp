#include "lidar_panoptic_clustering/tracking/instance_colors.h"

#include "lidar_panoptic_clustering/core/color_series.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = 0xFFFFFFFF;

VoxelKey cellOf(const Instances::Object& object, float side)
{
  return {static_cast<std::int32_t>(std::floor(object.x / side)),
          static_cast<std::int32_t>(std::floor(object.y / side)), static_cast<std::int32_t>(object.class_index)};
}
}  // namespace

void InstanceColors::collectPairs(const Instances& instances)
{
  grid_.reset();
  first_.clear();
  next_in_cell_.resize(previous_.size());
  pairs_.clear();
  for (std::uint32_t p = 0; p < previous_.size(); ++p)
  {
    const std::uint32_t cell = grid_.insert(cellOf(previous_[p], kGateM));
    if (cell == first_.size()) first_.push_back(kNone);
    next_in_cell_[p] = first_[cell];
    first_[cell] = p;
  }

  for (std::uint32_t c = 0; c < instances.count(); ++c)
  {
    const auto& object = instances.objects[c];
    const VoxelKey key = cellOf(object, kGateM);
    for (std::int32_t dx = -1; dx <= 1; ++dx)
      for (std::int32_t dy = -1; dy <= 1; ++dy)
      {
        const std::uint32_t cell = grid_.find({key.x + dx, key.y + dy, key.z});
        if (cell != VoxelIndex::kNone) comparePrevious(c, object, first_[cell]);
      }
  }
  pair_sort_.sort(
      pairs_, [](const Pair& pair) { return pair.squared_distance; },
      [](const Pair& a, const Pair& b) { return std::tie(a.current, a.previous) < std::tie(b.current, b.previous); });
}

/// Notes the objects of a cell's list that lie within the gate. A cell of 2 m that holds more than kMost objects of one
/// class shows no colours a person could follow; the rest of them is passed over, which keeps the time linear.
void InstanceColors::comparePrevious(std::uint32_t current, const Instances::Object& object, std::uint32_t first)
{
  constexpr int kMost = 16;
  int left = kMost;
  for (std::uint32_t p = first; p != kNone && left > 0; p = next_in_cell_[p], --left)
  {
    const float dx = object.x - previous_[p].x, dy = object.y - previous_[p].y;
    const float squared_distance = dx * dx + dy * dy;
    if (squared_distance < kGateM * kGateM) pairs_.push_back({squared_distance, current, p});
  }
}

const std::vector<std::uint32_t>& InstanceColors::follow(const Instances& instances)
{
  collectPairs(instances);
  colors_.assign(instances.count(), kNone);
  previous_taken_.assign(previous_.size(), false);
  for (const auto& pair : pairs_)
  {
    if (colors_[pair.current] != kNone || previous_taken_[pair.previous]) continue;
    colors_[pair.current] = previous_colors_[pair.previous];
    previous_taken_[pair.previous] = true;
  }
  for (auto& color : colors_)
    if (color == kNone) color = seriesColor(next_++);

  previous_ = instances.objects;
  previous_colors_ = colors_;
  return colors_;
}
}  // namespace lidar_panoptic_clustering
