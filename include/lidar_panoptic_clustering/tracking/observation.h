#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An object's extent in bird's-eye view along four axes 45 degrees apart: x, y, (x + y) / sqrt 2, (x - y) / sqrt 2.
struct Extent
{
  static constexpr std::size_t kAxes = 4;                                ///< directions in which the extent is kept
  static constexpr float kFar = std::numeric_limits<float>::infinity();  ///< of an empty extent

  std::array<float, kAxes> min{kFar, kFar, kFar, kFar};      ///< [m]
  std::array<float, kAxes> max{-kFar, -kFar, -kFar, -kFar};  ///< [m]

  /// Extends it to a point [m].
  void add(float x, float y)
  {
    constexpr float kHalfRoot = 0.70710678F;
    const std::array<float, kAxes> along{x, y, kHalfRoot * (x + y), kHalfRoot * (x - y)};
    for (std::size_t k = 0; k < kAxes; ++k)
    {
      min[k] = along[k] < min[k] ? along[k] : min[k];
      max[k] = along[k] > max[k] ? along[k] : max[k];
    }
  }
  /// By how far a point lies outside along the axis where that is most; negative inside [m].
  float distanceTo(float x, float y) const
  {
    constexpr float kHalfRoot = 0.70710678F;
    const std::array<float, kAxes> along{x, y, kHalfRoot * (x + y), kHalfRoot * (x - y)};
    float most = -kFar;
    for (std::size_t k = 0; k < kAxes; ++k)
    {
      most = min[k] - along[k] > most ? min[k] - along[k] : most;
      most = along[k] - max[k] > most ? along[k] - max[k] : most;
    }
    return most;
  }
  /// How much of it lies within another one, along the axis where that is least; below 0 outside.
  float shareWithin(const Extent& other) const
  {
    constexpr float kThinnestM = 0.05F;
    float least = 1.0F;
    for (std::size_t k = 0; k < kAxes; ++k)
    {
      const float shared =
          (max[k] < other.max[k] ? max[k] : other.max[k]) - (min[k] > other.min[k] ? min[k] : other.min[k]);
      const float length = max[k] - min[k] > kThinnestM ? max[k] - min[k] : kThinnestM;
      least = shared / length < least ? shared / length : least;
    }
    return least;
  }
  /// Whether a rectangle along one of the axes, about all of it, is at most `length` x `width` [m].
  bool fits(float length, float width) const
  {
    for (std::size_t k = 0; k < kAxes; ++k)
      if (max[k] - min[k] <= length && max[k ^ 1U] - min[k ^ 1U] <= width) return true;
    return false;
  }
  /// Whether all of it may lie in a rectangle of `length` x `width` [m] in any of sixteen directions. fits() knows the
  /// axes only: a car that stands 22.5 degrees off seems to be a metre and a half too wide there.
  bool fitsTurned(float length, float width) const;
  /// Extends it to all of another one.
  void add(const Extent& other)
  {
    for (std::size_t k = 0; k < kAxes; ++k)
    {
      min[k] = other.min[k] < min[k] ? other.min[k] : min[k];
      max[k] = other.max[k] > max[k] ? other.max[k] : max[k];
    }
  }
};

/// Whether objects of a class are small (people, bicycles): none is larger than usual because another thing stands
/// before it, and where a scan shows two things that are not near enough for one, they are two.
inline bool isSmall(const ClassInfo& info)
{
  constexpr float kSmallM = 2.0F;
  return info.length_m > 0.0F && info.length_m < kSmallM;
}

/// One instance of one scan, as the tracker sees it.
struct Observation
{
  std::uint32_t instance = 0;              ///< its id in the scan
  std::uint32_t point_count = 0;           ///< with coordinates
  ClassIndex class_index = kUnknownClass;  ///< of most of its points; the lower index wins a tie
  float class_share = 0.0F;                ///< of the points that are of that class
  Extent extent;                           ///< in the axes of the fixed frame, from Observations::origin
  float x = 0.0F, y = 0.0F;                ///< mean of its points, likewise
  float min_z = 0.0F, max_z = 0.0F;        ///< likewise [m]
};

/// The instances of one scan, and where the sensor was.
struct Observations
{
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< the sensor in the fixed frame [m]
  std::vector<Observation> list;                     ///< in order of each instance's first point
};

/// Gathers a scan's instances point by point; keeps its memory between scans.
class ObservationBuilder
{
public:
  /// Throws std::invalid_argument without a table.
  explicit ObservationBuilder(std::shared_ptr<const ClassTable> table);

  /// Begins a scan; `fixed_from_sensor`: where the sensor is in the fixed frame.
  void begin(const Eigen::Isometry3d& fixed_from_sensor);
  /// Adds a point of an instance (any id but 0), in the sensor frame [m]. Points without finite coordinates count for
  /// nothing, but their instance is entered. Returns the instance's place in Observations::list.
  std::uint32_t add(std::uint32_t instance, ClassIndex class_index, float x, float y, float z);
  /// Valid until the next begin().
  const Observations& finish();

private:
  std::uint32_t placeOf(std::uint32_t instance);

  std::shared_ptr<const ClassTable> table_;
  std::size_t classes_ = 0;
  Eigen::Matrix3f rotation_;
  Observations observations_;
  VoxelIndex place_of_;
  std::vector<std::uint32_t> votes_;  ///< by place and class
  std::vector<Eigen::Vector2d> sum_;  ///< by place
  std::uint32_t last_instance_ = 0, last_place_ = 0;
};
}  // namespace lidar_panoptic_clustering
