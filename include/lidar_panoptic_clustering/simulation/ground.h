#pragma once

#include "lidar_panoptic_clustering/simulation/course.h"
#include "lidar_panoptic_clustering/simulation/pose.h"
#include "lidar_panoptic_clustering/simulation/solid.h"

#include <cstdint>

#include <vector>

namespace lidar_panoptic_clustering::simulation
{
/// The street's cross-section, by distance from the centre line [m]; the same on both sides.
constexpr double kMarkingHalfWidth = 0.08, kRoadEdge = 5.0, kCurb = 7.2, kSidewalkEdge = 10.6;
constexpr double kCurbHeight = 0.12;  ///< what lies beyond the curb stands so much above the road, which is z = 0

/// Where a beam meets the ground.
struct GroundHit
{
  float range_m = 0.0F;    ///< from the sensor
  float incidence = 0.0F;  ///< cosine between the beam and the surface's normal
  Surface surface;         ///< what it meets
};

/// The ground as one pose of the sensor sees it: road, parking strip, curb, sidewalk, and gardens or yards beyond.
class Ground
{
public:
  /// The courtyards' pattern follows `seed`. Valid up to `reach_m` around the sensor.
  Ground(const Course& course, std::uint64_t seed, const Pose& sensor, double reach_m);

  /// Where a beam that points down ends; `direction` is a unit vector in the sensor frame. `beam_key` decides how
  /// deep it sinks into the grass.
  GroundHit hit(const Eigen::Vector3f& direction, std::uint64_t beam_key) const;
  /// No ground is nearer than this along `direction`.
  float nearest(const Eigen::Vector3f& direction) const
  {
    return (height_ - static_cast<float>(kCurbHeight) - kGrassHeight) / -direction.z();
  }

private:
  struct Place
  {
    float station, offset;  ///< station relative to the sensor's
  };
  Place place(const Eigen::Vector3f& point) const;
  Surface surfaceAt(const Place& place) const;

  static constexpr float kGrassHeight = 0.08F;

  std::uint64_t seed_;
  double station_, reach_;
  float height_, cosine_, sine_;
  struct Piece
  {
    float center_y, slope;  ///< of the course; y relative to the sensor's
    float cosine;           ///< of the course's heading
  };
  std::vector<Piece> pieces_;  ///< every metre of station
};
}  // namespace lidar_panoptic_clustering::simulation
