#include "lidar_panoptic_clustering/core/color_series.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
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
}  // namespace lidar_panoptic_clustering
