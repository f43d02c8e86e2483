#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
using namespace simulation;

namespace
{
constexpr double kFarthest = 1e9;  // [m] and [s]: positions in double keep well below a millimetre

const SimulatorConfig& validated(const SimulatorConfig& config)
{
  validateParameters(config);
  return config;
}

StreetConfig streetConfig(const SimulatorConfig& config)
{
  return {static_cast<std::uint64_t>(config.seed), config.parking_density, config.pedestrian_density};
}

TrafficConfig trafficConfig(const SimulatorConfig& config)
{
  return {static_cast<std::uint64_t>(config.seed), config.speed_mps, config.traffic_density, config.pedestrian_density};
}
}  // namespace

struct LidarSimulator::Echo
{
  float range_m = std::numeric_limits<float>::infinity();
  float incidence = 0.0F;  ///< cosine between beam and normal
  Surface surface;
};

LidarSimulator::LidarSimulator(const SensorModel& model, const SimulatorConfig& config)
    : model_(model), config_(validated(config)), street_(streetConfig(config), trafficConfig(config)), caster_(model)
{
}

double LidarSimulator::time(std::uint64_t frame) const
{
  const double seconds = static_cast<double>(frame) / config_.rate_hz;
  if (seconds > kFarthest || seconds * config_.speed_mps > kFarthest)
    throw std::invalid_argument("simulator: frame " + std::to_string(frame) +
                                " lies beyond 1e9 s or 1e9 m, the last it can make");
  return seconds;
}

std::map<std::uint32_t, Eigen::Vector2d> LidarSimulator::velocities(std::uint64_t frame, double reach_m)
{
  constexpr double kHalfStepS = 0.05;
  const double middle = time(frame);
  std::map<std::uint32_t, Eigen::Vector2d> before, velocities;
  const auto places = [&](double time_s)
  {
    std::map<std::uint32_t, Eigen::Vector2d> of;  // of each instance's first part, which is rigid
    street_.collect(time_s, config_.speed_mps * middle, reach_m, solids_);
    for (const Solid& solid : solids_)
      if (solid.surface.instance != 0) of.emplace(solid.surface.instance, solid.center.head<2>());
    return of;
  };
  before = places(middle - kHalfStepS);
  for (const auto& [instance, place] : places(middle + kHalfStepS))
    if (const auto at = before.find(instance); at != before.end())
      velocities.emplace(instance, (place - at->second) / (2.0 * kHalfStepS));
  return velocities;
}

Pose LidarSimulator::pose(std::uint64_t frame) const
{
  return street_.course().at(config_.speed_mps * time(frame), kEgoOffset, model_.mount_height_m);
}

void LidarSimulator::scan(std::uint64_t frame, PanopticCloud& out)
{
  const double seconds = time(frame);
  const Pose sensor = pose(frame);
  const std::uint64_t key = hash(static_cast<std::uint64_t>(config_.seed), frame);
  street_.collect(seconds, sensor.x, model_.max_range_m, solids_);
  caster_.cast(solids_, sensor, key);
  const Ground ground(street_.course(), static_cast<std::uint64_t>(config_.seed), sensor, model_.max_range_m);

  out.width = model_.columns;
  out.height = model_.rows();
  out.is_dense = false;
  out.points.resize(std::size_t{out.width} * out.height);
  for (std::uint32_t row = 0; row < out.height; ++row)
    for (std::uint32_t column = 0; column < out.width; ++column)
      sample(row, column, key, ground, out.points[std::size_t{row} * out.width + column]);
}

void LidarSimulator::sample(std::uint32_t row, std::uint32_t column, std::uint64_t key, const Ground& ground,
                            PanopticPoint& point) const
{
  const auto& direction = caster_.direction(row, column);
  const std::uint64_t beam_key = caster_.beamKey(key, row, column);
  const BeamEnd& end = caster_.at(row, column);
  Echo echo = solidEcho(end, direction);
  if (direction.z() < 0.0F && ground.nearest(direction) < end.range_m)
    if (const GroundHit hit = ground.hit(direction, beam_key); hit.range_m < echo.range_m)
      echo = {hit.range_m, hit.incidence, hit.surface};
  paint(echo, direction, beam_key, point);
}

LidarSimulator::Echo LidarSimulator::solidEcho(const BeamEnd& end, const Eigen::Vector3f& direction) const
{
  if (end.target < 0) return {};
  const Target& target = caster_.targets()[static_cast<std::size_t>(end.target)];
  const Eigen::Vector3f point = target.origin + end.range_m * (target.to_unit * direction);
  const Eigen::Vector3f normal = target.to_unit.transpose() * unitNormal(target.shape, point);
  return {end.range_m, std::abs(normal.normalized().dot(direction)), solids_[target.solid].surface};
}

void LidarSimulator::paint(const Echo& echo, const Eigen::Vector3f& direction, std::uint64_t beam_key,
                           PanopticPoint& point) const
{
  point = PanopticPoint();
  if (echo.range_m > model_.max_range_m + 1.0F)  // the sky
  {
    point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
    return;
  }
  const std::uint64_t noise = draw(beam_key, 1), chance = draw(beam_key, 2);
  const float range_m = echo.range_m + gaussian(noise) * model_.range_noise_m * static_cast<float>(config_.noise_scale);

  // less light comes back from far and from surfaces that the beam grazes: below 2 degrees (cosine 0.035) hardly any
  const float far = echo.range_m / model_.max_range_m, grazing = std::max(0.0F, 1.0F - echo.incidence / 0.035F);
  const float lost = model_.dropout + 0.35F * far * far + 0.8F * grazing * grazing;
  const bool returns = range_m >= model_.min_range_m && range_m <= model_.max_range_m &&
                       fraction(chance, 0) >= lost * static_cast<float>(config_.dropout_scale);
  if (!returns)
  {
    point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
    return;
  }
  point.x = range_m * direction.x();
  point.y = range_m * direction.y();
  point.z = range_m * direction.z();
  const float speckle = 0.9F + 0.2F * fraction(chance, 1);
  point.intensity = std::min(1.0F, echo.surface.reflectivity * (0.4F + 0.6F * echo.incidence) * speckle);
  point.label = echo.surface.label;
  point.instance = echo.surface.instance;
}
}  // namespace lidar_panoptic_clustering
