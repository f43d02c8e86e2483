#pragma once

#include "lidar_panoptic_clustering/simulation/pose.h"

#include <cmath>
#include <cstdint>

namespace lidar_panoptic_clustering::simulation
{
/// The street's centre line: a gentle sine about the world's x axis, without end in either direction.
///
/// A place on the street is its station (the world's x where the centre line passes it) and its offset, left of the
/// centre line as seen in driving direction, both in metres.
class Course
{
public:
  /// `seed` shifts the sine along the street.
  explicit Course(std::uint64_t seed) : phase_(static_cast<double>(seed % 1000) * 1e-3 * kTwoPi) {}

  /// World y of the centre line [m].
  double centerY(double station) const { return kAmplitudeM * std::sin(kTwoPi * station / kPeriodM + phase_); }
  /// Dy / dx of the centre line.
  double slope(double station) const
  {
    return kAmplitudeM * kTwoPi / kPeriodM * std::cos(kTwoPi * station / kPeriodM + phase_);
  }
  /// Of the driving direction [rad].
  double heading(double station) const { return std::atan(slope(station)); }

  /// `turn` [rad] is added to the street's heading.
  Pose at(double station, double offset, double z = 0.0, double turn = 0.0) const
  {
    const double yaw = heading(station);
    return {station - offset * std::sin(yaw), centerY(station) + offset * std::cos(yaw), z, yaw + turn};
  }

private:
  static constexpr double kTwoPi = 6.28318530717958647692;
  static constexpr double kAmplitudeM = 8.0, kPeriodM = 420.0;
  double phase_;
};
}  // namespace lidar_panoptic_clustering::simulation
