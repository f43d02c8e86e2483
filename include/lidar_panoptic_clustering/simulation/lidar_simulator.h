#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"
#include "lidar_panoptic_clustering/simulation/ground.h"
#include "lidar_panoptic_clustering/simulation/pose.h"
#include "lidar_panoptic_clustering/simulation/ray_caster.h"
#include "lidar_panoptic_clustering/simulation/street.h"

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The drive and the street.
struct SimulatorConfig
{
  int seed = 1;                     ///< another street with another traffic
  double rate_hz = 10.0;            ///< frame k is the moment k / rate_hz
  double speed_mps = 8.0;           ///< of the ego vehicle, along the street
  double noise_scale = 1.0;         ///< factor on the sensor model's range noise
  double dropout_scale = 1.0;       ///< factor on the probability that a beam does not return
  double traffic_density = 0.6;     ///< share of the places on the lanes that are taken
  double parking_density = 0.65;    ///< share of the parking strip that is taken
  double pedestrian_density = 0.5;  ///< share of the places on the sidewalks that are taken

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("seed", self.seed, 0, 2147483647);
    visitor("rate_hz", self.rate_hz, 0.1, 100.0);
    visitor("speed_mps", self.speed_mps, 0.0, 30.0);
    visitor("noise_scale", self.noise_scale, 0.0, 100.0);
    visitor("dropout_scale", self.dropout_scale, 0.0, 100.0);
    visitor("traffic_density", self.traffic_density, 0.0, 1.0);
    visitor("parking_density", self.parking_density, 0.0, 1.0);
    visitor("pedestrian_density", self.pedestrian_density, 0.0, 1.0);
  }
};

/// A lidar on a vehicle that drives along an endless street, with exact labels.
///
/// Every frame is a function of model, config and frame number alone. A frame is one instant: the vehicle does not
/// move while the sensor turns. Not shared between threads.
class LidarSimulator
{
public:
  /// Throws std::invalid_argument, naming the parameter, where model or config is out of range.
  explicit LidarSimulator(const SensorModel& model = SensorModel::load("hdl64e"), const SimulatorConfig& config = {});

  /// Fills `out` with one scan: height = rings (row 0 the highest), width = columns (see SensorModel::azimuth), sensor
  /// frame x forward, y left, z up. No return is NaN. Labels are raw SemanticKITTI ids, resting and moving ones;
  /// `instance` is 0 for stuff, for things the same 16-bit id from frame to frame; intensity 0..1; rgb 0. The header is
  /// left alone. Throws std::invalid_argument beyond 1e9 m of driving or 1e9 s.
  void scan(std::uint64_t frame, PanopticCloud& out);

  /// The sensor in the world; throws as scan does.
  simulation::Pose pose(std::uint64_t frame) const;

  /// The true velocity in the world of each instance within `reach_m` [m/s], by id; throws as scan does.
  std::map<std::uint32_t, Eigen::Vector2d> velocities(std::uint64_t frame, double reach_m);

  /// Of the sensor.
  const SensorModel& model() const { return model_; }
  /// As given.
  const SimulatorConfig& config() const { return config_; }

private:
  struct Echo;
  double time(std::uint64_t frame) const;
  void sample(std::uint32_t row, std::uint32_t column, std::uint64_t key, const simulation::Ground& ground,
              PanopticPoint& point) const;
  Echo solidEcho(const simulation::BeamEnd& end, const Eigen::Vector3f& direction) const;
  void paint(const Echo& echo, const Eigen::Vector3f& direction, std::uint64_t beam_key, PanopticPoint& point) const;

  SensorModel model_;
  SimulatorConfig config_;
  simulation::Street street_;
  simulation::RayCaster caster_;
  std::vector<simulation::Solid> solids_;
};
}  // namespace lidar_panoptic_clustering
