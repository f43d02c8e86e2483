#include "lidar_panoptic_clustering/simulation/models.h"

#include <Eigen/Geometry>

#include <cmath>

namespace lidar_panoptic_clustering::simulation
{
ObjectBuilder::ObjectBuilder(std::vector<Solid>& solids, const Pose& pose, std::uint32_t label, std::uint32_t instance)
    : solids_(solids), pose_(pose)
{
  const auto cosine = static_cast<float>(std::cos(pose.yaw)), sine = static_cast<float>(std::sin(pose.yaw));
  rotation_ << cosine, -sine, 0.0F, sine, cosine, 0.0F, 0.0F, 0.0F, 1.0F;
  surface_.label = label;
  surface_.instance = instance;
}

ObjectBuilder& ObjectBuilder::label(std::uint32_t label)
{
  surface_.label = label;
  return *this;
}

ObjectBuilder& ObjectBuilder::surface(float reflectivity, float transmission, float depth_m)
{
  surface_.reflectivity = reflectivity;
  surface_.transmission = transmission;
  surface_.depth_m = depth_m;
  return *this;
}

ObjectBuilder& ObjectBuilder::box(const Eigen::Vector3f& center, const Eigen::Vector3f& size)
{
  add(Shape::kBox, center, (0.5F * size).asDiagonal());
  return *this;
}

ObjectBuilder& ObjectBuilder::ellipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& size)
{
  add(Shape::kEllipsoid, center, (0.5F * size).asDiagonal());
  return *this;
}

ObjectBuilder& ObjectBuilder::bar(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius)
{
  const Eigen::Vector3f axis = 0.5F * (to - from);
  const Eigen::Vector3f across = axis.unitOrthogonal();
  Eigen::Matrix3f half_axes;
  half_axes << radius * across, radius * axis.normalized().cross(across), axis;
  add(Shape::kCylinder, 0.5F * (from + to), half_axes);
  return *this;
}

ObjectBuilder& ObjectBuilder::panel(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width,
                                    float thickness)
{
  const Eigen::Vector3f along = 0.5F * (to - from), side = 0.5F * width * Eigen::Vector3f::UnitY();
  Eigen::Matrix3f half_axes;
  half_axes << along, side, 0.5F * thickness * along.cross(side).normalized();
  add(Shape::kBox, 0.5F * (from + to), half_axes);
  return *this;
}

void ObjectBuilder::add(Shape shape, const Eigen::Vector3f& center, const Eigen::Matrix3f& half_axes)
{
  Solid solid;
  solid.shape = shape;
  solid.center = Eigen::Vector3d(pose_.x, pose_.y, pose_.z) + (rotation_ * center).cast<double>();
  solid.half_axes = rotation_ * half_axes;
  solid.surface = surface_;
  solids_.push_back(solid);
}
}  // namespace lidar_panoptic_clustering::simulation
