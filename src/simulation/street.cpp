#include "lidar_panoptic_clustering/simulation/street.h"

#include <cmath>

namespace lidar_panoptic_clustering::simulation
{
Street::Street(const StreetConfig& street, const TrafficConfig& traffic)
    : config_(street), course_(street.seed), traffic_(traffic, course_)
{
}

void Street::collect(double time_s, double station, double reach_m, std::vector<Solid>& solids)
{
  const auto first = static_cast<std::int64_t>(std::floor((station - reach_m) / kBlockLengthM));
  const auto last = static_cast<std::int64_t>(std::floor((station + reach_m) / kBlockLengthM));
  blocks_.erase(blocks_.begin(), blocks_.lower_bound(first));
  blocks_.erase(blocks_.upper_bound(last), blocks_.end());

  solids.clear();
  for (std::int64_t index = first; index <= last; ++index)
  {
    auto it = blocks_.find(index);
    if (it == blocks_.end()) it = blocks_.emplace(index, buildBlock(config_, course_, index)).first;
    solids.insert(solids.end(), it->second.begin(), it->second.end());
  }
  traffic_.collect(time_s, station, reach_m, solids);
}
}  // namespace lidar_panoptic_clustering::simulation
