#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A spinning lidar: a ring of beams an elevation, all fired at the same azimuths.
///
/// Read from YAML (config/sensors/*.yaml, which name the source of each value). Elevations and columns must be given;
/// the defaults of the rest suit a lidar on a car's roof.
struct SensorModel
{
  std::string name;
  std::vector<float> elevations_rad;                ///< one a ring, strictly descending: row 0 is the highest beam
  std::uint32_t columns = 0;                        ///< firings in the horizontal field of view
  double horizontal_fov_rad = 6.28318530717958648;  ///< centred on the x axis (ahead); less than a turn for a sector
  float min_range_m = 0.5F;
  float max_range_m = 120.0F;
  float range_noise_m = 0.02F;  ///< standard deviation along the beam
  float dropout = 0.02F;        ///< probability that a beam at short range and steep incidence does not return
  float mount_height_m = 1.73F;

  std::uint32_t rows() const { return static_cast<std::uint32_t>(elevations_rad.size()); }
  /// Whether the last column is the first one's neighbour.
  bool fullTurn() const;
  /// The sensor turns clockwise: column 0 looks to the far left, in a full turn to the rear (just right of azimuth pi);
  /// the middle column looks ahead.
  float azimuth(std::uint32_t column) const;

  /// `name_or_path`: a sensor that ships with the package ("hdl64e", "vlp16", ...), or a YAML file.
  /// Throws std::runtime_error when there is no such file, std::invalid_argument when its content is wrong;
  /// both name the file, the key, what was expected and what was found.
  static SensorModel load(const std::string& name_or_path);
  static SensorModel parse(const std::string& yaml, const std::string& source);
  /// The sensors that ship with the package.
  static std::vector<std::string> shippedNames();
};

/// Throws std::invalid_argument, naming `source` and the member, on a model that no scan can be made with.
void validateSensorModel(const SensorModel& model, const std::string& source = "sensor model");
}  // namespace lidar_panoptic_clustering
