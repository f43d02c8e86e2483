#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The beam of a sensor whose elevation is nearest to a point's: a look-up, then one or two comparisons.
class BeamTable
{
public:
  /// `elevations_rad`: strictly descending, at least one, as SensorModel has them.
  explicit BeamTable(const std::vector<float>& elevations_rad);

  std::uint32_t rows() const { return static_cast<std::uint32_t>(lower_sine_.size()); }

  /// `sine`: of the elevation, z / range, in [-1, 1]. Points beyond the outermost beams belong to those.
  std::uint32_t nearest(float sine) const
  {
    const auto bin = static_cast<std::uint32_t>(std::max(0.0F, 1.0F - sine) * (0.5F * kBins));
    std::uint32_t beam = first_of_bin_[bin < kBins ? bin : kBins - 1];
    while (sine < lower_sine_[beam]) ++beam;
    return beam;
  }

  /// How far `sine` lies from `beam`, its nearest: 0 for a point on it, 0.5 half way to the next one on that side; at
  /// most 1. Of a table with a single beam always 0.
  float misfit(float sine, std::uint32_t beam) const
  {
    const float off = sine - sine_[beam];
    const std::uint32_t other =
        off > 0.0F ? (beam > 0 ? beam - 1 : beam + 1) : (beam + 1 < rows() ? beam + 1 : beam - 1);
    return rows() > 1 ? std::min(1.0F, std::abs(off / (sine_[other] - sine_[beam]))) : 0.0F;
  }

private:
  static constexpr std::uint32_t kBins = 4096;  // 0.03 deg at the horizon, a sixth of the finest beam spacing there is

  std::vector<float> sine_;                  ///< by beam
  std::vector<float> lower_sine_;            ///< by beam: half way to the next lower one; -2 for the lowest
  std::vector<std::uint32_t> first_of_bin_;  ///< the highest beam that reaches into the bin; bin 0 looks straight up
};
}  // namespace lidar_panoptic_clustering
