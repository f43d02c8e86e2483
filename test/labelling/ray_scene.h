#pragma once

#include "lidar_panoptic_clustering/projection/sensor_model.h"
#include "scan_fixture.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A box along the axes [m]; the origin is the ground under the sensor.
struct SceneBox
{
  Eigen::Vector3f low, high;
};

/// Boxes on a sloped plane, as a lidar sees them that stands straight over the origin.
struct RayScene
{
  float mount_height = 1.73F;            ///< [m]
  float slope_x = 0.0F, slope_y = 0.0F;  ///< of the ground, rise over run
  std::vector<SceneBox> boxes;
  Eigen::Quaternionf tilt = Eigen::Quaternionf::Identity();  ///< the points are given in a frame turned by this
};

struct RaySensor
{
  std::uint32_t rows = 64, columns = 1024;
  float top_deg = 3.0F, bottom_deg = -25.0F;
  float from_deg = 180.0F, turn_deg = 360.0F;  ///< clockwise from there
  float max_range = 80.0F;                     ///< [m]
};

/// What a scan's returns hit.
constexpr int kMissed = -2, kGroundHit = -1;  // else the box's number

/// Distance along the ray, infinite where it misses; the ray starts outside.
inline float distanceTo(const SceneBox& box, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction)
{
  const Eigen::Array3f inverse = direction.array().inverse();
  const Eigen::Array3f a = (box.low - origin).array() * inverse, b = (box.high - origin).array() * inverse;
  const float enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
  return enter > 0.0F && enter <= leave ? enter : std::numeric_limits<float>::infinity();
}

/// The nearest hit along a ray from the sensor, infinite where there is none; `hit` gets what it is.
inline float nearestHit(const RayScene& scene, const Eigen::Vector3f& direction, int& hit)
{
  const Eigen::Vector3f origin(0.0F, 0.0F, scene.mount_height);
  const float down = scene.slope_x * direction.x() + scene.slope_y * direction.y() - direction.z();
  float nearest = down > 0.0F ? scene.mount_height / down : std::numeric_limits<float>::infinity();
  hit = kGroundHit;
  for (std::size_t b = 0; b < scene.boxes.size(); ++b)
  {
    const float distance = distanceTo(scene.boxes[b], origin, direction);
    if (distance < nearest) nearest = distance, hit = static_cast<int>(b);
  }
  return nearest;
}

inline Eigen::Vector3f directionOf(float elevation, float azimuth)
{
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

/// Row 0 is the highest beam. `hits` gets what each pixel shows.
inline LabelledCloud castScene(const RayScene& scene, const RaySensor& sensor, std::vector<int>& hits)
{
  constexpr float kDegree = 3.14159265F / 180.0F;
  LabelledCloud cloud = emptyCloud(sensor.rows, sensor.columns);
  hits.assign(cloud.size(), kMissed);
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
  {
    const float row = static_cast<float>(i / sensor.columns), column = static_cast<float>(i % sensor.columns);
    const float elevation = kDegree * (sensor.top_deg + (sensor.bottom_deg - sensor.top_deg) * row /
                                                            static_cast<float>(std::max(1U, sensor.rows - 1)));
    const float azimuth =
        kDegree * (sensor.from_deg - sensor.turn_deg * (column + 0.37F) / static_cast<float>(sensor.columns));
    const Eigen::Vector3f direction = directionOf(elevation, azimuth);
    int hit = kMissed;
    const float nearest = nearestHit(scene, direction, hit);
    if (!(nearest < sensor.max_range)) continue;
    cloud.points[i].getVector3fMap() = scene.tilt * Eigen::Vector3f(nearest * direction);
    hits[i] = hit;
  }
  return cloud;
}

/// The same by the beams of a sensor file, in the sector of `sector_deg` ahead.
inline LabelledCloud castScene(const RayScene& scene, const SensorModel& sensor, float sector_deg,
                               std::vector<int>& hits)
{
  const std::uint32_t skipped = static_cast<std::uint32_t>(static_cast<float>(sensor.columns) * 0.5F *
                                                           std::max(0.0F, 1.0F - sector_deg / 360.0F));
  const std::uint32_t columns = sensor.columns - 2 * skipped;
  LabelledCloud cloud = emptyCloud(sensor.rows(), columns);
  hits.assign(cloud.size(), kMissed);
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
  {
    const Eigen::Vector3f direction =
        directionOf(sensor.elevations_rad[i / columns], sensor.azimuth(skipped + i % columns));
    int hit = kMissed;
    const float nearest = nearestHit(scene, direction, hit);
    if (!(nearest < sensor.max_range_m)) continue;
    cloud.points[i].getVector3fMap() = nearest * direction;
    hits[i] = hit;
  }
  return cloud;
}
}  // namespace lidar_panoptic_clustering
