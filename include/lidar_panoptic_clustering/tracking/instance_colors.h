#pragma once

#include "lidar_panoptic_clustering/core/instances.h"
#include "lidar_panoptic_clustering/geometry/step_sort.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Gives every instance a colour, the one of the instance it follows where there is one, so that a picture of
/// consecutive scans does not flicker. Ids do not depend on it.
class InstanceColors
{
public:
  /// An instance follows the nearest one of the scan before, of its class, whose centre lies within 2 m in
  /// bird's-eye view (nearest pairs first). Takes expected linear time: centres are looked up on a grid.
  /// Returns the colours, by instance id - 1; valid until the next call.
  const std::vector<std::uint32_t>& follow(const Instances& instances);

  /// What follow() returned last.
  const std::vector<std::uint32_t>& colors() const { return colors_; }

  /// Forgets the scan before (a new sequence, a jump in time).
  void reset() { previous_.clear(); }

private:
  static constexpr float kGateM = 2.0F;  // 20 m/s relative speed at 10 Hz

  struct Pair
  {
    float squared_distance;
    std::uint32_t current, previous;
  };
  void collectPairs(const Instances& instances);
  void comparePrevious(std::uint32_t current, const Instances::Object& object, std::uint32_t first);

  std::vector<Instances::Object> previous_;
  std::vector<std::uint32_t> previous_colors_, colors_;
  VoxelIndex grid_;
  std::vector<std::uint32_t> first_;  ///< by occupied cell: its last object of the scan before
  std::vector<std::uint32_t> next_in_cell_;
  std::vector<Pair> pairs_;
  FloatSort<Pair> pair_sort_;
  std::vector<bool> previous_taken_;
  std::uint32_t next_ = 0;
};
}  // namespace lidar_panoptic_clustering
