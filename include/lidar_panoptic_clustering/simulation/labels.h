#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>

/// Raw ids of SemanticKITTI (semantic-kitti-api, config/semantic-kitti.yaml) that occur in the simulated street.
namespace lidar_panoptic_clustering::simulation::label
{
constexpr std::uint32_t kCar = 10, kBicycle = 11, kBus = 13, kMotorcycle = 15, kTruck = 18, kOtherVehicle = 20;
constexpr std::uint32_t kPerson = 30, kBicyclist = 31;
constexpr std::uint32_t kRoad = 40, kParking = 44, kSidewalk = 48, kOtherGround = 49, kLaneMarking = 60;
constexpr std::uint32_t kBuilding = 50, kFence = 51, kVegetation = 70, kTrunk = 71, kTerrain = 72;
constexpr std::uint32_t kPole = 80, kTrafficSign = 81;
constexpr std::uint32_t kMovingCar = 252, kMovingBicyclist = 253, kMovingPerson = 254, kMovingMotorcyclist = 255;
constexpr std::uint32_t kMovingBus = 257, kMovingTruck = 258;
}  // namespace lidar_panoptic_clustering::simulation::label
