#include "lidar_panoptic_clustering/core/instance_colors.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = 0xFFFFFFFF;

std::int64_t cellOf(float metres, float cell)
{
  return static_cast<std::int64_t>(std::floor(metres / cell));
}
std::int64_t cellKey(std::int64_t column, std::int64_t row)
{
  return column * 1000003 + row;
}

/// Hue 0..1, full value, to 0x00RRGGBB.
std::uint32_t fromHsv(float hue, float saturation, float value)
{
  const auto channel = [&](float shift)
  {
    const float k = std::fmod(shift + hue * 6.0F, 6.0F);
    const float c = value - value * saturation * std::max(0.0F, std::min({k, 4.0F - k, 1.0F}));
    return static_cast<std::uint32_t>(std::lround(c * 255.0F));
  };
  return channel(5.0F) << 16 | channel(3.0F) << 8 | channel(1.0F);
}
}  // namespace

std::uint32_t seriesColor(std::uint32_t k)
{
  // steps of the golden ratio never come close to an earlier hue for long; three shades part the near ones
  const float hue = std::fmod(static_cast<float>(k % 10007U) * 0.61803399F, 1.0F);
  constexpr float kSaturation[] = {0.85F, 0.55F, 0.95F};
  constexpr float kValue[] = {1.0F, 1.0F, 0.75F};
  return fromHsv(hue, kSaturation[k % 3], kValue[k % 3]);
}

void InstanceColors::collectPairs(const Instances& instances)
{
  grid_.clear();
  pairs_.clear();
  for (std::uint32_t p = 0; p < previous_.size(); ++p)
    grid_.emplace(cellKey(cellOf(previous_[p].x, kGateM), cellOf(previous_[p].y, kGateM)), p);

  for (std::uint32_t c = 0; c < instances.count(); ++c)
  {
    const auto& object = instances.objects[c];
    const std::int64_t column = cellOf(object.x, kGateM), row = cellOf(object.y, kGateM);
    for (std::int64_t dc = -1; dc <= 1; ++dc)
      for (std::int64_t dr = -1; dr <= 1; ++dr)
      {
        const auto [begin, end] = grid_.equal_range(cellKey(column + dc, row + dr));
        for (auto it = begin; it != end; ++it)
        {
          const auto& before = previous_[it->second];
          const float dx = object.x - before.x, dy = object.y - before.y;
          const float squared_distance = dx * dx + dy * dy;
          if (before.class_index == object.class_index && squared_distance < kGateM * kGateM)
            pairs_.push_back({squared_distance, c, it->second});
        }
      }
  }
  std::sort(pairs_.begin(), pairs_.end(),
            [](const Pair& a, const Pair& b) {
              return std::tie(a.squared_distance, a.current, a.previous) <
                     std::tie(b.squared_distance, b.current, b.previous);
            });
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
