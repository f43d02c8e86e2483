#include "lidar_panoptic_clustering/projection/beam_table.h"

#include <cmath>

namespace lidar_panoptic_clustering
{
BeamTable::BeamTable(const std::vector<float>& elevations_rad)
{
  for (const float elevation : elevations_rad) sine_.push_back(std::sin(elevation));
  for (std::size_t i = 0; i + 1 < elevations_rad.size(); ++i)
    lower_sine_.push_back(std::sin(0.5F * (elevations_rad[i] + elevations_rad[i + 1])));
  lower_sine_.push_back(-2.0F);

  std::uint32_t beam = 0;
  for (std::uint32_t bin = 0; bin < kBins; ++bin)
  {
    // one bin of slack for the rounding of nearest()
    const float top = 1.0F - 2.0F * (static_cast<float>(bin) - 1.0F) / kBins;
    while (top < lower_sine_[beam]) ++beam;
    first_of_bin_.push_back(beam);
  }
}
}  // namespace lidar_panoptic_clustering
