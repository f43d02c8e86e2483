#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <vector>

namespace lidar_panoptic_clustering
{
/// z = slope_x x + slope_y y + offset [m], sensor frame.
struct SlopedPlane
{
  float slope_x = 0.0F, slope_y = 0.0F, offset = 0.0F;  ///< z = slope_x x + slope_y y + offset [m]

  /// Above the plane, along z [m].
  float heightOf(float x, float y, float z) const { return z - slope_x * x - slope_y * y - offset; }
};

/// The lowest return of a place.
struct LowReturn
{
  float x, y, z;  ///< [m], sensor frame
};

/// The plane that most of the lowest returns around a sensor lie on: a vote over slopes of up to 12 degrees each way
/// and offsets down to 12 m below the sensor, then least squares through what lies near it, four times.
///
/// Returns whether it may be the ground: ten returns at least, and a tenth of them, lie on it, and it is below the
/// sensor (above it is the ground of a sensor that stands on its head). Linear in the returns.
bool findGroundPlane(const std::vector<LowReturn>& lowest, SlopedPlane& plane);
}  // namespace lidar_panoptic_clustering
