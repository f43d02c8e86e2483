#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"
#include "lidar_panoptic_clustering/simulation/labels.h"
#include "lidar_panoptic_clustering/simulation/models.h"
#include "lidar_panoptic_clustering/simulation/ray_caster.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What stands in the scene of the refinement's pictures, as raw SemanticKITTI instances.
enum StepSceneObject : std::uint32_t
{
  kMislabelledCar = 1,  ///< the network took its front half for a truck
  kPersonBesideIt,
  kFirstParkedCar,  ///< bumper to bumper with the second
  kSecondParkedCar,
  kHiddenCar,  ///< a pillar hides its middle
  kCyclist
};

namespace detail
{
inline std::vector<simulation::Solid> stepSceneSolids()
{
  using namespace simulation;
  std::vector<Solid> solids;
  addCar(solids, {11.0, 6.3, 0.0, 0.0}, label::kCar, kMislabelledCar, Random(11));
  addPerson(solids, {11.5, 4.2, 0.0, 0.0}, label::kPerson, kPersonBesideIt, 0.3F, Random(12));
  addCar(solids, {7.5, -4.6, 0.0, 0.0}, label::kCar, kFirstParkedCar, Random(13));
  addCar(solids, {12.35, -4.6, 0.0, 0.0}, label::kCar, kSecondParkedCar, Random(14));
  addCar(solids, {19.5, 0.2, 0.0, 1.5708}, label::kCar, kHiddenCar, Random(15));
  ObjectBuilder(solids, {9.0, 0.1, 0.0, 0.0}, label::kPole).bar({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 3.2F}, 0.28F);
  addBicyclist(solids, {4.5, 3.2, 0.0, 0.1}, label::kBicyclist, kCyclist, Random(16));
  return solids;
}
}  // namespace detail

/// A scan of five vehicles and a person, seen by an HDL-64E without noise that stands at the origin, with the labels as
/// a network might give them. `instance` is the true object, 0 for stuff.
inline PanopticCloud stepScene()
{
  const SensorModel model = SensorModel::load("hdl64e");
  const auto solids = detail::stepSceneSolids();
  simulation::RayCaster caster(model);
  caster.cast(solids, {0.0, 0.0, model.mount_height_m, 0.0}, 1);

  PanopticCloud cloud(model.columns, model.rows(), PanopticPoint());
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < cloud.width; ++column)
    {
      PanopticPoint& point = cloud.points[std::size_t{row} * cloud.width + column];
      const auto& direction = caster.direction(row, column);
      const auto& end = caster.at(row, column);
      const float ground_m = direction.z() < 0.0F ? model.mount_height_m / -direction.z() : 1e9F;
      const bool on_solid = end.target >= 0 && end.range_m < ground_m;
      const float range_m = on_solid ? end.range_m : ground_m;
      point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
      if (range_m > model.max_range_m) continue;
      point.getVector3fMap() = range_m * direction;
      point.label = simulation::label::kRoad;
      if (!on_solid) continue;
      const auto& surface = solids[caster.targets()[static_cast<std::size_t>(end.target)].solid].surface;
      point.label = surface.label, point.instance = surface.instance;
      if (point.instance == kMislabelledCar && point.x > 11.6F) point.label = simulation::label::kTruck;
    }
  return cloud;
}
}  // namespace lidar_panoptic_clustering
