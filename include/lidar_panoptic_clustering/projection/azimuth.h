#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
/// The azimuth of a finite (x, y) in [-pi, pi] [rad], counter-clockwise from +x, to 2e-6 rad (a column of 2048 is 3e-3
/// wide), monotone, several times faster than std::atan2. 0 for (0, 0).
///
/// Odd minimax polynomial of the arc tangent on [0, 1] (Hastings, Approximations for Digital Computers, 1955).
inline float fastAzimuth(float x, float y)
{
  constexpr float pi = 3.14159265358979F;
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(ax, ay);
  const float t = larger > 0.0F ? std::min(ax, ay) / larger : 0.0F;
  const float s = t * t;
  const float series = 0.19354346F + s * (-0.11643287F + s * (0.05265332F - s * 0.01172120F));
  float angle = t * (0.99997726F + s * (-0.33262347F + s * series));
  if (ay > ax) angle = pi / 2 - angle;
  if (x < 0.0F) angle = pi - angle;
  return y < 0.0F ? -angle : angle;
}
}  // namespace lidar_panoptic_clustering
