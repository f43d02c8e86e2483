#pragma once

#include "lidar_panoptic_clustering/projection/sensor_model.h"
#include "lidar_panoptic_clustering/simulation/pose.h"
#include "lidar_panoptic_clustering/simulation/random.h"
#include "lidar_panoptic_clustering/simulation/solid.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering::simulation
{
/// A solid as the sensor sees it, with the part of the range image it can fall on.
struct Target
{
  Shape shape = Shape::kBox;                  ///< of the solid
  Eigen::Matrix3f to_unit;                    ///< turns directions of the sensor frame into the unit shape's
  Eigen::Vector3f origin;                     ///< the sensor in the unit shape's frame
  float transmission = 0.0F, depth_m = 0.0F;  ///< see Surface
  std::uint32_t solid = 0;                    ///< its index in the list of solids

  float near_m = 0.0F;                              ///< no point of it is nearer
  std::int32_t column_begin = 0, column_count = 0;  ///< columns it can fall on; they go round behind the last
  std::uint32_t row_begin = 0, row_end = 0;         ///< rows it can fall on
};

/// Where a beam ends.
struct BeamEnd
{
  float range_m = std::numeric_limits<float>::infinity();  ///< infinity where it meets nothing
  std::int32_t target = -1;                                ///< index into RayCaster::targets, -1 for nothing
};

/// Finds the nearest solid on every beam of a lidar.
///
/// Each solid is tested only with the beams inside the azimuth and elevation interval of its bounding box, nearest
/// solids first, so that what stands behind them costs a comparison. Not shared between threads.
class RayCaster
{
public:
  /// Throws std::invalid_argument as validateSensorModel does.
  explicit RayCaster(const SensorModel& model);

  /// Beams end at max_range_m and at the plane mount_height_m below the sensor, whatever comes first. `key` decides
  /// which beams pass glass and foliage; the same arguments give the same result.
  void cast(const std::vector<Solid>& solids, const Pose& sensor, std::uint64_t key);

  /// Of the last cast; valid until the next.
  const BeamEnd& at(std::uint32_t row, std::uint32_t column) const { return ends_[column * rows_ + row]; }
  /// Of the last cast, nearest first.
  const std::vector<Target>& targets() const { return targets_; }

  /// Unit vector of a beam, sensor frame (x forward, y left, z up).
  const Eigen::Vector3f& direction(std::uint32_t row, std::uint32_t column) const
  {
    return directions_[column * rows_ + row];
  }
  /// How far a beam of this row can go: to the ground plane or the maximum range [m].
  float limit(std::uint32_t row) const { return limits_[row]; }
  /// A random value a beam and key.
  std::uint64_t beamKey(std::uint64_t key, std::uint32_t row, std::uint32_t column) const
  {
    return simulation::draw(key, std::uint64_t{row} * columns_ + column);
  }

  /// Range at which one beam ends on one target, infinity where it misses or passes.
  static float range(const Target& target, const Eigen::Vector3f& direction, std::uint64_t beam_key);

private:
  bool makeTarget(const Solid& solid, const Pose& sensor, Target& target) const;
  bool boundRows(float low_z, float high_z, float nearest_m, float farthest_m, Target& target) const;
  bool boundColumns(float first_azimuth, float last_azimuth, Target& target) const;
  void render(const Target& target, std::int32_t index, std::uint64_t key);

  std::uint32_t rows_, columns_;
  float max_range_m_, fov_rad_;
  bool full_turn_;
  std::vector<float> tangents_, limits_;     ///< a row
  std::vector<Eigen::Vector3f> directions_;  ///< column by column: a solid's rows lie together
  std::vector<BeamEnd> ends_;
  std::vector<Target> targets_;
};
}  // namespace lidar_panoptic_clustering::simulation
