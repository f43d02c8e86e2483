#include "lidar_panoptic_clustering/simulation/models.h"

namespace lidar_panoptic_clustering::simulation
{
namespace
{
constexpr float kGlass = 0.4F;  // share of the beams that pass a window
constexpr float kTyre = 0.08F;  // reflectivity

/// A pair of wheels on one axle.
void addAxle(ObjectBuilder& object, float x, float track, float radius, float width)
{
  object.surface(kTyre);
  for (const float side : {-1.0F, 1.0F})
  {
    const float y = side * 0.5F * track;
    object.bar({x, y - side * width, radius}, {x, y, radius}, radius);
  }
}

/// Both wheels of a two-wheeler.
void addWheels(ObjectBuilder& object, float wheelbase, float radius, float width)
{
  object.surface(kTyre);
  for (const float x : {-0.5F * wheelbase, 0.5F * wheelbase})
    object.bar({x, -0.5F * width, radius}, {x, 0.5F * width, radius}, radius);
}

/// Someone on a saddle at `x`, `height`, leaning to handles ahead.
void addRider(ObjectBuilder& object, float x, float height, float lean)
{
  object.surface(0.35F);
  object.bar({x, 0.0F, height}, {x + lean, 0.0F, height + 0.55F}, 0.17F);
  for (const float y : {-0.12F, 0.12F})
  {
    object.bar({x, y, height}, {x + 0.38F, y, height - 0.2F}, 0.08F);
    object.bar({x + 0.38F, y, height - 0.2F}, {x + 0.25F, y, height - 0.65F}, 0.06F);
    object.bar({x + lean, 1.6F * y, height + 0.48F}, {x + 0.55F, 2.0F * y, height + 0.2F}, 0.05F);
  }
  object.ellipsoid({x + lean + 0.06F, 0.0F, height + 0.75F}, {0.24F, 0.2F, 0.3F});
}

void addBicycleFrame(ObjectBuilder& object)
{
  addWheels(object, 1.06F, 0.34F, 0.05F);
  object.surface(0.4F);
  object.bar({-0.53F, 0.0F, 0.34F}, {-0.15F, 0.0F, 0.85F}, 0.03F);
  object.bar({-0.15F, 0.0F, 0.8F}, {0.4F, 0.0F, 0.8F}, 0.03F);
  object.bar({-0.05F, 0.0F, 0.3F}, {0.4F, 0.0F, 0.8F}, 0.03F);
  object.bar({0.53F, 0.0F, 0.34F}, {0.38F, 0.0F, 1.0F}, 0.03F);
  object.bar({0.38F, -0.28F, 1.0F}, {0.38F, 0.28F, 1.0F}, 0.025F);
  object.box({-0.17F, 0.0F, 0.9F}, {0.26F, 0.14F, 0.08F});
}

void addMotorcycleBody(ObjectBuilder& object)
{
  addWheels(object, 1.4F, 0.31F, 0.13F);
  object.surface(0.4F);
  object.ellipsoid({0.05F, 0.0F, 0.62F}, {1.25F, 0.42F, 0.55F});
  object.box({-0.45F, 0.0F, 0.78F}, {0.7F, 0.28F, 0.12F});
  object.bar({0.7F, 0.0F, 0.31F}, {0.5F, 0.0F, 1.02F}, 0.06F);
  object.bar({0.48F, -0.36F, 1.02F}, {0.48F, 0.36F, 1.02F}, 0.03F);
}
}  // namespace

Footprint addCar(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                 Random random)
{
  const float length = random.uniform(3.7F, 4.9F), width = random.uniform(1.68F, 1.88F);
  const float height = random.uniform(1.42F, 1.72F), paint = random.uniform(0.1F, 0.9F);
  const float trunk = random.uniform(0.02F, 0.2F) * length;  // 0: hatchback
  const float waist = 0.6F * height, front = 0.5F * length, rear = -front, tail = rear + trunk;

  ObjectBuilder car(solids, pose, label, instance);
  car.surface(paint);
  car.box({0.0F, 0.0F, 0.43F}, {length, width, 0.42F});
  car.box({-0.02F * length, 0.0F, 0.5F * (waist + 0.6F)}, {0.93F * length, 0.97F * width, waist - 0.6F});
  const float roof_front = 0.08F * length, roof_rear = tail + 0.1F * length;
  car.box({0.5F * (roof_front + roof_rear), 0.0F, height - 0.03F}, {roof_front - roof_rear, 0.8F * width, 0.06F});
  car.surface(0.15F, kGlass);
  car.panel({0.27F * length, 0.0F, waist}, {roof_front, 0.0F, height - 0.04F}, 0.82F * width, 0.04F);
  car.panel({tail, 0.0F, waist}, {roof_rear, 0.0F, height - 0.04F}, 0.82F * width, 0.04F);
  car.box({0.5F * (roof_front + roof_rear), 0.0F, 0.5F * (waist + height) - 0.03F},
          {roof_front - roof_rear, 0.86F * width, height - waist - 0.06F});
  addAxle(car, 0.31F * length, width, 0.32F, 0.2F);
  addAxle(car, -0.3F * length, width, 0.32F, 0.2F);
  return {length, width};
}

Footprint addTruck(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                   Random random)
{
  const float length = random.uniform(6.2F, 9.5F), width = random.uniform(2.2F, 2.5F);
  const float height = random.uniform(2.9F, 3.7F), paint = random.uniform(0.3F, 0.9F);
  const float front = 0.5F * length, cargo = length - 2.2F;

  ObjectBuilder truck(solids, pose, label, instance);
  truck.surface(paint);
  truck.box({-front + 0.5F * cargo, 0.0F, 0.5F * (height + 1.0F)}, {cargo, width, height - 1.0F});
  truck.box({front - 0.95F, 0.0F, 1.05F}, {1.9F, 0.94F * width, 1.1F});
  truck.box({front - 1.15F, 0.0F, 2.55F}, {1.5F, 0.9F * width, 0.2F});
  truck.surface(0.15F, kGlass);
  truck.box({front - 1.0F, 0.0F, 2.05F}, {1.7F, 0.92F * width, 0.9F});
  truck.surface(0.2F);
  truck.box({0.0F, 0.0F, 0.85F}, {0.9F * length, 0.8F, 0.25F});
  addAxle(truck, front - 1.2F, width, 0.48F, 0.3F);
  addAxle(truck, -0.3F * length, width, 0.48F, 0.5F);
  return {length, width};
}

Footprint addBus(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                 Random random)
{
  const float length = random.uniform(10.5F, 12.0F), paint = random.uniform(0.3F, 0.8F);
  constexpr float kWidth = 2.5F, kHeight = 3.0F;

  ObjectBuilder bus(solids, pose, label, instance);
  bus.surface(paint);
  bus.box({0.0F, 0.0F, 0.78F}, {length, kWidth, 0.9F});
  bus.box({0.0F, 0.0F, 0.5F * (kHeight + 2.3F)}, {length, kWidth, kHeight - 2.3F});
  for (const float share : {-0.49F, -0.25F, 0.0F, 0.25F, 0.48F})
    bus.box({share * length, 0.0F, 1.75F}, {0.2F, kWidth - 0.04F, 1.1F});
  bus.surface(0.15F, kGlass);
  bus.box({0.0F, 0.0F, 1.75F}, {length - 0.06F, kWidth - 0.1F, 1.1F});
  addAxle(bus, 0.27F * length, kWidth, 0.48F, 0.3F);
  addAxle(bus, -0.25F * length, kWidth, 0.48F, 0.5F);
  return {length, kWidth};
}

Footprint addTrailer(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                     Random random)
{
  const float length = random.uniform(4.2F, 5.6F), height = random.uniform(2.2F, 2.6F);
  constexpr float kWidth = 2.1F;

  ObjectBuilder trailer(solids, pose, label, instance);
  trailer.surface(0.7F);
  trailer.box({-0.4F, 0.0F, 0.5F * (height + 0.45F)}, {length - 0.8F, kWidth, height - 0.45F});
  trailer.bar({0.5F * length - 0.9F, 0.0F, 0.5F}, {0.5F * length, 0.0F, 0.5F}, 0.08F);
  addAxle(trailer, -0.4F, kWidth + 0.02F, 0.32F, 0.2F);
  return {length, kWidth};
}

Footprint addBicycle(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance)
{
  ObjectBuilder bicycle(solids, pose, label, instance);
  addBicycleFrame(bicycle);
  return {1.75, 0.6};
}

Footprint addBicyclist(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                       Random random)
{
  const float lean = random.uniform(0.12F, 0.38F);
  ObjectBuilder bicyclist(solids, pose, label, instance);
  addBicycleFrame(bicyclist);
  addRider(bicyclist, -0.17F, 0.95F, lean);
  return {1.75, 0.65};
}

Footprint addMotorcycle(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance)
{
  ObjectBuilder motorcycle(solids, pose, label, instance);
  addMotorcycleBody(motorcycle);
  return {2.05, 0.75};
}

Footprint addMotorcyclist(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                          Random random)
{
  const float lean = random.uniform(0.05F, 0.25F);
  ObjectBuilder motorcyclist(solids, pose, label, instance);
  addMotorcycleBody(motorcyclist);
  addRider(motorcyclist, -0.3F, 0.85F, lean);
  return {2.05, 0.8};
}

void addPerson(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance, float stride,
               Random random)
{
  const float scale = random.uniform(0.88F, 1.08F), clothes = random.uniform(0.1F, 0.6F);  // of 1.75 m
  ObjectBuilder person(solids, pose, label, instance);
  person.surface(clothes);
  for (const float side : {-1.0F, 1.0F})
  {
    const float swing = 0.28F * stride * side, y = 0.1F * side;
    person.bar(scale * Eigen::Vector3f(0.0F, y, 0.85F), scale * Eigen::Vector3f(swing, y, 0.02F), 0.085F * scale);
    person.bar(scale * Eigen::Vector3f(0.0F, 2.4F * y, 1.4F), scale * Eigen::Vector3f(-0.7F * swing, 2.5F * y, 0.85F),
               0.055F * scale);
  }
  person.ellipsoid(scale * Eigen::Vector3f(0.0F, 0.0F, 1.15F), scale * Eigen::Vector3f(0.3F, 0.44F, 0.78F));
  person.ellipsoid(scale * Eigen::Vector3f(0.02F, 0.0F, 1.62F), scale * Eigen::Vector3f(0.21F, 0.18F, 0.27F));
}
}  // namespace lidar_panoptic_clustering::simulation
