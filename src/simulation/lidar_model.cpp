#include "lidar_panoptic_clustering/simulation/lidar_model.h"

#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

float radians(double degrees)
{
  return static_cast<float>(degrees * kPi / 180.0);
}

void require(bool holds, const std::string& member, const std::string& expected, double value)
{
  if (!holds)
    throw std::invalid_argument("lidar model: " + member + " must be " + expected + ", but is " +
                                std::to_string(value));
}
}  // namespace

float LidarModel::azimuth(std::uint32_t column) const
{
  return static_cast<float>(kPi - (column + 0.5) * 2.0 * kPi / columns);
}

LidarModel hdl64e()
{
  LidarModel model;
  model.name = "HDL-64E";
  for (int i = 0; i < 32; ++i) model.elevations_rad.push_back(radians(2.0 - i / 3.0));
  for (int i = 0; i < 32; ++i) model.elevations_rad.push_back(radians(-8.83 - i / 2.0));
  model.columns = 2048;
  model.min_range_m = 0.9F;
  model.max_range_m = 120.0F;
  model.range_noise_m = 0.015F;
  model.dropout = 0.02F;
  model.mount_height_m = 1.73F;
  return model;
}

void validateModel(const LidarModel& model)
{
  require(!model.elevations_rad.empty(), "number of rings", "1 or more", 0.0);
  for (std::size_t i = 0; i < model.elevations_rad.size(); ++i)
  {
    const float elevation = model.elevations_rad[i];
    const std::string member = "elevation of ring " + std::to_string(i);
    require(std::abs(elevation) < kPi / 2, member, "between -pi/2 and pi/2", elevation);
    require(i == 0 || elevation < model.elevations_rad[i - 1], member, "below the ring before", elevation);
  }
  require(model.columns > 0, "columns", "1 or more", model.columns);
  require(model.min_range_m >= 0.0F, "min_range_m", "0 or more", model.min_range_m);
  require(model.max_range_m > model.min_range_m && std::isfinite(model.max_range_m), "max_range_m",
          "finite and more than min_range_m", model.max_range_m);
  require(model.range_noise_m >= 0.0F && std::isfinite(model.range_noise_m), "range_noise_m", "0 or more",
          model.range_noise_m);
  require(model.dropout >= 0.0F && model.dropout <= 1.0F, "dropout", "a probability", model.dropout);
  require(model.mount_height_m > 0.0F && std::isfinite(model.mount_height_m), "mount_height_m", "more than 0",
          model.mount_height_m);
}
}  // namespace lidar_panoptic_clustering
