#include "grid_clusterer.h"

#include <cmath>

namespace grid_clustering_example
{
namespace
{
/// Link and square in one number. Squares are counted modulo 2^24: with those of 1 mm that is every 16 km.
std::uint64_t keyOf(std::uint8_t link, std::int64_t column, std::int64_t row)
{
  constexpr std::uint64_t kMask = (1U << 24U) - 1;
  return static_cast<std::uint64_t>(link) << 48U | (static_cast<std::uint64_t>(column) & kMask) << 24U |
         (static_cast<std::uint64_t>(row) & kMask);
}
}  // namespace

void GridClusterer::cluster(const lidar_panoptic_clustering::ThingScan& scan, std::vector<std::uint32_t>& component)
{
  sets_.reset(scan.size());
  first_in_.clear();
  for (std::uint32_t i = 0; i < scan.size(); ++i)
  {
    const auto column = static_cast<std::int64_t>(std::floor(scan.points[i].x / cell_m_));
    const auto row = static_cast<std::int64_t>(std::floor(scan.points[i].y / cell_m_));
    if (const auto [first, is_new] = first_in_.emplace(keyOf(scan.link[i], column, row), i); !is_new)
    {
      sets_.unite(first->second, i);
      continue;
    }
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        if (const auto found = first_in_.find(keyOf(scan.link[i], column + dx, row + dy)); found != first_in_.end())
          sets_.unite(found->second, i);
  }
  sets_.flatten(component);
}
}  // namespace grid_clustering_example
