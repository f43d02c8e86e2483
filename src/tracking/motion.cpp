#include "lidar_panoptic_clustering/tracking/motion.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kHalfRoot = 0.70710678118654752;
constexpr double kAxis[Extent::kAxes][2] = {{1.0, 0.0}, {0.0, 1.0}, {kHalfRoot, kHalfRoot}, {kHalfRoot, -kHalfRoot}};
}  // namespace

MotionPrior MotionPrior::of(const ClassInfo& info)
{
  const double length = info.length_m > 0.0F ? static_cast<double>(info.length_m) : 4.5;
  MotionPrior prior;
  prior.speed_mps = std::min(2.2 * length, 10.0);
  prior.accel_mps2 = std::clamp(0.3 * prior.speed_mps, 1.0, 3.0);
  prior.outline_m = 0.2 + 0.05 * std::min(length, 12.0);
  prior.occlusion_m = 0.2 + 0.25 * std::min(length, 12.0);
  return prior;
}

Displacement displacementOf(const Extent& expected, const Extent& seen)
{
  Displacement displacement;
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    const double low = static_cast<double>(seen.min[k]) - expected.min[k];
    const double high = static_cast<double>(seen.max[k]) - expected.max[k];
    const bool is_held = (low > 0.0) != (high > 0.0);
    displacement.shift[k] = is_held ? 0.0 : std::abs(low) < std::abs(high) ? low : high;
    displacement.doubt[k] = 0.5 * std::abs(high - low);
  }
  return displacement;
}

MotionState MotionState::at(double x, double y, double noise_m, const MotionPrior& prior)
{
  MotionState state;
  state.mean << x, y, 0.0, 0.0;
  const double position = noise_m * noise_m, speed = prior.speed_mps * prior.speed_mps;
  state.covariance = Eigen::Vector4d(position, position, speed, speed).asDiagonal();
  return state;
}

void MotionState::predict(double dt, const MotionPrior& prior)
{
  Eigen::Matrix4d transition = Eigen::Matrix4d::Identity();
  transition(0, 2) = transition(1, 3) = dt;
  mean = transition * mean;
  covariance = transition * covariance * transition.transpose();
  const double q = prior.accel_mps2 * prior.accel_mps2;
  for (int i = 0; i < 2; ++i)
  {
    covariance(i, i) += q * dt * dt * dt * dt / 4.0;
    covariance(i, i + 2) += q * dt * dt * dt / 2.0;
    covariance(i + 2, i) += q * dt * dt * dt / 2.0;
    covariance(i + 2, i + 2) += q * dt * dt;
  }
}

void MotionState::correct(const Displacement& displacement, double noise_m)
{
  const Eigen::Vector2d expected = mean.head<2>();
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    const Eigen::Vector2d axis(kAxis[k][0], kAxis[k][1]);
    const Eigen::Vector4d reach = covariance.leftCols<2>() * axis;
    // four axes see the plane's two dimensions twice
    const double noise = 2.0 * (noise_m * noise_m + displacement.doubt[k] * displacement.doubt[k]);
    const double variance = axis.dot(reach.head<2>()) + noise;
    const double innovation = displacement.shift[k] - axis.dot(mean.head<2>() - expected);
    mean += reach * (innovation / variance);
    covariance -= reach * reach.transpose() / variance;
  }
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
}

double MotionState::variance(std::size_t axis) const
{
  const Eigen::Vector2d a(kAxis[axis][0], kAxis[axis][1]);
  return a.dot(covariance.topLeftCorner<2, 2>() * a);
}
}  // namespace lidar_panoptic_clustering
