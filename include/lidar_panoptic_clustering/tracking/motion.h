#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/tracking/observation.h"

#include <Eigen/Core>
#include <array>

namespace lidar_panoptic_clustering
{
/// What is known of an object's motion and outline before it is seen, by the usual length of its class.
struct MotionPrior
{
  double speed_mps = 10.0;   ///< standard deviation of the speed it may have at first sight
  double accel_mps2 = 3.0;   ///< of its acceleration
  double outline_m = 0.4;    ///< of where its outline seems to be, from scan to scan
  double occlusion_m = 1.3;  ///< of how much of it may come into sight or go out of it

  /// An object moves some two of its lengths in a second (a person 2, a bicycle 4, a car 10 m/s); what is longer than a
  /// car is not faster, and where a class has no size it may be a car.
  static MotionPrior of(const ClassInfo& info);
};

/// How an outline lies to the one that was expected.
struct Displacement
{
  std::array<double, Extent::kAxes> shift;  ///< along each axis [m], see displacementOf
  std::array<double, Extent::kAxes> doubt;  ///< half of what the outline grew or shrank by [m]
};

/// By how much an outline has moved, from its two edges along each axis. An object that is partly hidden shows one edge
/// where it was and loses the other: the edge that moved less tells, and where one outline holds the other neither did.
Displacement displacementOf(const Extent& expected, const Extent& seen);

/// Position and velocity in the plane of an object that keeps its velocity but for accelerations that nobody foresees:
/// a Kalman filter with constant velocity.
struct MotionState
{
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();            ///< x, y [m], velocity in x, y [m/s]
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  ///< of the mean

  /// At rest, as far as the prior knows.
  static MotionState at(double x, double y, double noise_m, const MotionPrior& prior);

  /// `dt` [s], 0 or more.
  void predict(double dt, const MotionPrior& prior);
  /// Takes in a displacement against what was expected; the doubt of an axis adds to `noise_m`.
  void correct(const Displacement& displacement, double noise_m);
  /// Variance of the position along an axis of Extent [m^2].
  double variance(std::size_t axis) const;
};
}  // namespace lidar_panoptic_clustering
