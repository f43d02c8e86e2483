#include "lidar_panoptic_clustering/core/one_sweep.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
struct Direction
{
  double x, y;       ///< horizontal
  double elevation;  ///< [rad]
};
}  // namespace

bool comesInOneSweep(const LabelledCloud& cloud)
{
  constexpr double kMostTurned = 1.1 * 6.28318530717958648;
  constexpr double kElevationSlack = 0.005;  // [rad], a centimetre of noise at 2 m
  const std::size_t allowed = 2 + cloud.size() / 20;
  std::size_t left = 0, right = 0, jumps = 0;
  double turned = 0.0;
  Direction last{0.0, 0.0, 0.0};
  bool first = true;
  for (const auto& p : cloud.points)
  {
    const double x = p.x, y = p.y, z = p.z, squared_range = x * x + y * y + z * z;
    if (!(squared_range > 0.0) || std::isinf(squared_range)) continue;
    const Direction here{x, y, std::atan2(z, std::hypot(x, y))};
    if (!first)
    {
      const double turn = std::atan2(last.x * y - last.y * x, last.x * x + last.y * y);
      left += turn > 0.0, right += turn < 0.0;
      jumps += std::abs(here.elevation - last.elevation) > std::abs(turn) + kElevationSlack;
      turned += std::abs(turn);
      if (std::min(left, right) > allowed || jumps > allowed || turned > kMostTurned) return false;
    }
    last = here;
    first = false;
  }
  return true;
}
}  // namespace lidar_panoptic_clustering
