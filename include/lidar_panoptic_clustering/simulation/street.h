#pragma once

#include "lidar_panoptic_clustering/simulation/course.h"
#include "lidar_panoptic_clustering/simulation/solid.h"
#include "lidar_panoptic_clustering/simulation/traffic.h"

#include <cstdint>
#include <map>
#include <vector>

namespace lidar_panoptic_clustering::simulation
{
/// How much stands beside the street, as shares of the places there are.
struct StreetConfig
{
  std::uint64_t seed = 0;           ///< another street
  double parking_density = 0.65;    ///< of the parking strip
  double pedestrian_density = 0.5;  ///< standing ones; those that walk belong to the traffic
};

/// What stands still on 50 m of the street: parked vehicles, sidewalk furniture, trees, buildings.
///
/// A function of config and index alone. Instances are 1..49152 and come again after 768 blocks (38 km).
std::vector<Solid> buildBlock(const StreetConfig& config, const Course& course, std::int64_t index);

constexpr double kBlockLengthM = 50.0;
/// Ids above belong to the traffic.
constexpr std::uint32_t kLastStaticInstance = 49152;

/// An endless street with its traffic. Keeps the blocks in reach; what it gives does not depend on what was asked
/// before. Not shared between threads.
class Street
{
public:
  /// Both configs have to have the same seed, or traffic and street do not belong together.
  Street(const StreetConfig& street, const TrafficConfig& traffic);

  /// Exchanges `solids` for those within `reach_m` of `station` (and some beyond) at a time.
  void collect(double time_s, double station, double reach_m, std::vector<Solid>& solids);
  /// The centre line.
  const Course& course() const { return course_; }

private:
  StreetConfig config_;
  Course course_;
  Traffic traffic_;
  std::map<std::int64_t, std::vector<Solid>> blocks_;
};
}  // namespace lidar_panoptic_clustering::simulation
