#pragma once

#include "lidar_panoptic_clustering/simulation/pose.h"
#include "lidar_panoptic_clustering/simulation/random.h"
#include "lidar_panoptic_clustering/simulation/solid.h"

#include <vector>

namespace lidar_panoptic_clustering::simulation
{
/// Composes one object of boxes, bars and ellipsoids given in its own frame: x ahead, y left, z up from the ground.
class ObjectBuilder
{
public:
  /// Adds to `solids`, which has to outlive it.
  ObjectBuilder(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance = 0);

  /// The label, reflectivity, transmission and depth of all that is added from here on.
  ObjectBuilder& label(std::uint32_t label);
  /// See Surface.
  ObjectBuilder& surface(float reflectivity, float transmission = 0.0F, float depth_m = 0.0F);

  /// `size`: the full extents along x, y, z.
  ObjectBuilder& box(const Eigen::Vector3f& center, const Eigen::Vector3f& size);
  /// `size`: the full extents along x, y, z.
  ObjectBuilder& ellipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& size);
  /// A cylinder from one point to another.
  ObjectBuilder& bar(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius);
  /// A flat box whose middle line runs from one point to another in a plane of constant y, `width` along y.
  ObjectBuilder& panel(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width, float thickness);

private:
  void add(Shape shape, const Eigen::Vector3f& center, const Eigen::Matrix3f& half_axes);

  std::vector<Solid>& solids_;
  Pose pose_;
  Eigen::Matrix3f rotation_;
  Surface surface_;
};

/// Length and width of a vehicle [m].
struct Footprint
{
  double length, width;  ///< [m]
};

/// Each adds one object of the given raw label and instance to `solids`; its look (size, colour, build) follows
/// `random`, the same for the same
/// stream. The pose is the middle of its footprint, heading along x.
Footprint addCar(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                 Random random);
Footprint addTruck(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                   Random random);
Footprint addBus(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                 Random random);
Footprint addTrailer(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                     Random random);
Footprint addBicycle(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance);
Footprint addBicyclist(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                       Random random);
Footprint addMotorcycle(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance);
Footprint addMotorcyclist(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance,
                          Random random);
/// `stride` swings the legs, -1..1; 0 stands.
void addPerson(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance, float stride,
               Random random);

void addTree(std::vector<Solid>& solids, const Pose& pose, Random random);
void addBush(std::vector<Solid>& solids, const Pose& pose, Random random);
void addHedge(std::vector<Solid>& solids, const Pose& pose, float length, float height);
void addFence(std::vector<Solid>& solids, const Pose& pose, float length, Random random);
void addLamp(std::vector<Solid>& solids, const Pose& pose);
void addTrafficSign(std::vector<Solid>& solids, const Pose& pose, Random random);
/// A house whose front faces -y, `length` along x; its pose is the middle of the front.
void addBuilding(std::vector<Solid>& solids, const Pose& pose, float length, float height, Random random);
}  // namespace lidar_panoptic_clustering::simulation
