#include "lidar_panoptic_clustering/simulation/traffic.h"

#include "lidar_panoptic_clustering/simulation/ground.h"
#include "lidar_panoptic_clustering/simulation/labels.h"
#include "lidar_panoptic_clustering/simulation/models.h"
#include "lidar_panoptic_clustering/simulation/street.h"

#include <array>
#include <cmath>

namespace lidar_panoptic_clustering::simulation
{
namespace
{
enum class Kind
{
  kVehicle,
  kBicyclist,
  kPedestrian
};

constexpr std::uint32_t kLanes = 8, kPlaces = 512, kPerPlace = 3;
static_assert(kLastStaticInstance + kLanes * kPlaces * kPerPlace < 65536, "instances are 16 bits");
}  // namespace

struct Traffic::Lane
{
  Kind kind;
  double offset;   ///< [m]
  double speed;    ///< [m/s], negative against the ego vehicle's direction
  double spacing;  ///< from place to place [m]
  double scatter;  ///< of what stands in a place, either side of its middle [m]
  double sway;     ///< falling back and catching up [m]
};

void Traffic::collect(double time_s, double station, double reach_m, std::vector<Solid>& solids) const
{
  // scatter and sway leave room between neighbours of the largest kind
  const std::array<Lane, kLanes> lanes = {{
      {Kind::kVehicle, kEgoOffset, config_.ego_speed_mps, 26.0, 3.0, 1.0},
      {Kind::kVehicle, -kEgoOffset, -8.5, 24.0, 4.0, 1.0},
      {Kind::kBicyclist, -4.0, 4.6, 21.0, 7.0, 0.5},
      {Kind::kBicyclist, 4.0, -4.3, 27.0, 9.0, 0.5},
      {Kind::kPedestrian, -8.5, 1.3, 9.0, 3.0, 0.2},
      {Kind::kPedestrian, -9.55, -1.2, 12.0, 4.0, 0.2},
      {Kind::kPedestrian, 8.5, -1.25, 9.0, 3.0, 0.2},
      {Kind::kPedestrian, 9.55, 1.15, 13.0, 4.0, 0.2},
  }};
  for (std::uint32_t lane = 0; lane < kLanes; ++lane)
  {
    const double start = lanes[lane].speed * time_s;
    const auto first = static_cast<std::int64_t>(std::floor((station - reach_m - start) / lanes[lane].spacing));
    const auto last = static_cast<std::int64_t>(std::ceil((station + reach_m - start) / lanes[lane].spacing));
    for (std::int64_t place = first; place <= last; ++place)
      if (lane != 0 || place != 0) addPlace(lanes[lane], lane, place, time_s, solids);  // 0 in lane 0: the ego vehicle
  }
}

void Traffic::addPlace(const Lane& lane, std::uint32_t lane_index, std::int64_t place, double time_s,
                       std::vector<Solid>& solids) const
{
  Random random(hash(hash(config_.seed, 100 + lane_index), static_cast<std::uint64_t>(place)));
  if (!random.chance(lane.kind == Kind::kPedestrian ? config_.pedestrian_density : config_.density)) return;

  const double scatter = lane.scatter * random.uniform(-1.0, 1.0), phase = random.uniform(0.0, 6.283);
  const double station = static_cast<double>(place) * lane.spacing + lane.speed * time_s + scatter +
                         lane.sway * std::sin(0.25 * time_s + phase);
  const double drift = random.uniform(-0.15, 0.15), turn = lane.speed < 0.0 ? 3.14159265358979 : 0.0;
  const auto row = static_cast<std::uint32_t>(((place % kPlaces) + kPlaces) % kPlaces);
  const std::uint32_t instance = kLastStaticInstance + 1 + (lane_index * kPlaces + row) * kPerPlace;

  if (lane.kind == Kind::kVehicle)
    return addVehicle(course_.at(station, lane.offset + drift, 0.0, turn), instance, random, solids);
  if (lane.kind == Kind::kBicyclist)
  {
    addBicyclist(solids, course_.at(station, lane.offset + drift, 0.0, turn), label::kMovingBicyclist, instance,
                 random);
    return;
  }
  const int group = random.chance(0.65) ? 1 : 2 + random.below(2);
  for (int i = 0; i < group; ++i)  // one behind the other, half a step aside
  {
    const double behind = 0.75 * i, aside = (i % 2 == 0 ? -0.2 : 0.2) * (group > 1 ? 1.0 : 0.0);
    const auto stride = static_cast<float>(std::sin(5.5 * time_s + phase + i));
    const Pose pose = course_.at(station - behind, lane.offset + drift + aside, kCurbHeight, turn);
    addPerson(solids, pose, label::kMovingPerson, instance + static_cast<std::uint32_t>(i), stride,
              Random(random.next()));
  }
}

void Traffic::addVehicle(const Pose& pose, std::uint32_t instance, Random random, std::vector<Solid>& solids) const
{
  const double kind = random.uniform(0.0, 1.0);
  if (kind < 0.74)
    addCar(solids, pose, label::kMovingCar, instance, random);
  else if (kind < 0.83)
    addTruck(solids, pose, label::kMovingTruck, instance, random);
  else if (kind < 0.89)
    addBus(solids, pose, label::kMovingBus, instance, random);
  else
    addMotorcyclist(solids, pose, label::kMovingMotorcyclist, instance, random);
}
}  // namespace lidar_panoptic_clustering::simulation
