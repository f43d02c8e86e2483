#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lidar_panoptic_clustering::simulation
{
/// What a beam finds where it ends.
struct Surface
{
  std::uint32_t label = 0;
  std::uint32_t instance = 0;  ///< 0 for stuff
  float reflectivity = 0.3F;   ///< share of the light sent back, 0..1
  float transmission = 0.0F;   ///< probability that a beam passes: glass, foliage, wire fences
  float depth_m = 0.0F;        ///< beams end up to this far below the surface: foliage
};

enum class Shape : std::uint8_t
{
  kBox,       ///< [-1, 1]^3
  kCylinder,  ///< radius 1 about z, -1 <= z <= 1
  kEllipsoid  ///< radius 1
};

/// A unit shape, scaled and rotated into the world.
struct Solid
{
  Shape shape = Shape::kBox;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();         ///< [m]
  Eigen::Matrix3f half_axes = Eigen::Matrix3f::Identity();  ///< columns: orthogonal, as long as half the extent [m]
  Surface surface;
};

/// The part of a line origin + t * direction that lies inside a shape: enter <= t <= exit.
struct Chord
{
  float enter = 0.0F, exit = 0.0F;
};

namespace detail
{
inline bool clipSlab(float origin, float direction, Chord& chord)
{
  const float inverse = 1.0F / direction;
  const float a = (-1.0F - origin) * inverse, b = (1.0F - origin) * inverse;
  chord.enter = std::max(chord.enter, std::min(a, b));
  chord.exit = std::min(chord.exit, std::max(a, b));
  return chord.enter <= chord.exit;
}

/// Roots of a t^2 + 2 b t + c.
inline bool clipQuadric(float a, float b, float c, Chord& chord)
{
  const float discriminant = b * b - a * c;
  if (discriminant < 0.0F) return false;
  const float root = std::sqrt(discriminant), inverse = 1.0F / a;
  chord.enter = std::max(chord.enter, (-b - root) * inverse);
  chord.exit = std::min(chord.exit, (-b + root) * inverse);
  return chord.enter <= chord.exit;
}
}  // namespace detail

/// Clips a line with a unit shape; both in the shape's frame. False when they do not meet.
inline bool intersect(Shape shape, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, Chord& chord)
{
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  chord = {-kInfinity, kInfinity};
  switch (shape)
  {
    case Shape::kBox:
      return detail::clipSlab(origin.x(), direction.x(), chord) && detail::clipSlab(origin.y(), direction.y(), chord) &&
             detail::clipSlab(origin.z(), direction.z(), chord);
    case Shape::kCylinder:
      return detail::clipSlab(origin.z(), direction.z(), chord) &&
             detail::clipQuadric(direction.head<2>().squaredNorm(), direction.head<2>().dot(origin.head<2>()),
                                 origin.head<2>().squaredNorm() - 1.0F, chord);
    case Shape::kEllipsoid:
      return detail::clipQuadric(direction.squaredNorm(), direction.dot(origin), origin.squaredNorm() - 1.0F, chord);
  }
  return false;
}

/// The outward normal of a unit shape at a point of its surface, not normalised.
inline Eigen::Vector3f unitNormal(Shape shape, const Eigen::Vector3f& point)
{
  if (shape == Shape::kEllipsoid) return point;
  if (shape == Shape::kCylinder && std::abs(point.z()) < 0.999F) return {point.x(), point.y(), 0.0F};
  if (shape == Shape::kCylinder) return {0.0F, 0.0F, point.z()};
  Eigen::Index axis = 0;
  point.cwiseAbs().maxCoeff(&axis);
  return Eigen::Vector3f::Unit(axis) * point[axis];
}
}  // namespace lidar_panoptic_clustering::simulation
