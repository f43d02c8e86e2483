#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A spinning lidar: a ring of beams an elevation, all fired at the same azimuths, the full turn.
struct LidarModel
{
  std::string name;
  std::vector<float> elevations_rad;  ///< one a ring, strictly descending: row 0 is the highest beam
  std::uint32_t columns = 0;          ///< firings a turn
  float min_range_m = 0.0F;
  float max_range_m = 0.0F;
  float range_noise_m = 0.0F;  ///< standard deviation along the beam
  float dropout = 0.0F;        ///< probability that a beam at short range and steep incidence does not return
  float mount_height_m = 0.0F;

  std::uint32_t rows() const { return static_cast<std::uint32_t>(elevations_rad.size()); }
  /// Column 0 looks to the rear (just right of azimuth pi), the sensor turns clockwise: the middle column looks ahead.
  float azimuth(std::uint32_t column) const;
};

/// Velodyne HDL-64E as SemanticKITTI has it: 64 x 2048, mounted at 1.73 m (Geiger et al. 2012, "Are we ready for
/// autonomous driving?"). Vertical angles, 120 m range and noise below 2 cm: HDL-64E S2 user manual; its upper block
/// spans +2.00 to -8.33 deg in steps of 1/3 deg, its lower one -8.83 to -24.33 deg in steps of 1/2 deg.
LidarModel hdl64e();

/// Throws std::invalid_argument, naming the member, on a model that no scan can be made with.
void validateModel(const LidarModel& model);
}  // namespace lidar_panoptic_clustering
