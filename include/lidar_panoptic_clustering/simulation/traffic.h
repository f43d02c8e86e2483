#pragma once

#include "lidar_panoptic_clustering/simulation/course.h"
#include "lidar_panoptic_clustering/simulation/random.h"
#include "lidar_panoptic_clustering/simulation/solid.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering::simulation
{
/// How much moves, and how fast.
struct TrafficConfig
{
  std::uint64_t seed = 0;           ///< other traffic
  double ego_speed_mps = 8.0;       ///< the ego vehicle's lane moves at this speed, and it has a place of its own in it
  double density = 0.6;             ///< share of the places on the lanes that are taken
  double pedestrian_density = 0.5;  ///< of those that walk on the sidewalks
};

/// The ego vehicle's lane, left of the centre line [m].
constexpr double kEgoOffset = -1.65;

/// What moves: vehicles, cyclists and pedestrians, each lane an endless row of numbered places that moves along the
/// street, so that every moment can be computed directly.
///
/// Instances are 49153..61440; a place's ids come again with every 512th place of its lane.
class Traffic
{
public:
  /// Along `course`.
  Traffic(const TrafficConfig& config, const Course& course) : config_(config), course_(course) {}

  /// Adds what is within `reach_m` of `station` at a time.
  void collect(double time_s, double station, double reach_m, std::vector<Solid>& solids) const;

private:
  struct Lane;
  void addPlace(const Lane& lane, std::uint32_t lane_index, std::int64_t place, double time_s,
                std::vector<Solid>& solids) const;
  void addVehicle(const Pose& pose, std::uint32_t instance, Random random, std::vector<Solid>& solids) const;

  TrafficConfig config_;
  Course course_;
};
}  // namespace lidar_panoptic_clustering::simulation
