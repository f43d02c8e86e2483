#pragma once

#include "lidar_panoptic_clustering/geometry/voxel_index.h"
#include "lidar_panoptic_clustering/projection/hidden_points.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Carries what clustering found in the image of a scan back to the points as they were sent.
///
/// Buffers are kept between scans; not shared between threads.
class OriginalLabeller
{
public:
  static constexpr std::uint32_t kNoTrack = 0x7FFFFFFF;  ///< ids above it do not last

  /// `table`: the classes that were clustered with. `lasting_ids`: instances are tracks' ids; hidden objects of their
  /// own, which no pixel shows, are numbered from kNoTrack + 1 then, for a track may have any id below.
  explicit OriginalLabeller(std::shared_ptr<const ClassTable> table, bool lasting_ids = false);

  /// `clustered`: what a FramePipeline painted of scan.image.cloud. Of that cloud only the size is used here, so that
  /// its points may have been moved on.
  ///
  /// Writes a label and an instance a point, by sent index. A point that its pixel shows gets the pixel's; a hidden one
  /// the instance it belongs to as HiddenPointLabeller has it, and the class that instance was voted to have, its own
  /// where nothing was voted. Throws std::invalid_argument when the sizes contradict each other. Linear.
  void carryBack(const OrganizedScan& scan, const PanopticCloud& clustered, std::vector<std::uint32_t>& label,
                 std::vector<std::uint32_t>& instance);

private:
  static void copyPixels(const Projection& image, const PanopticCloud& clustered, std::vector<std::uint32_t>& label,
                         std::vector<std::uint32_t>& instance);
  void takeVotes(const OrganizedScan& scan, const PanopticCloud& clustered);

  std::shared_ptr<const ClassTable> table_;
  HiddenPointLabeller hidden_points_;
  std::vector<std::uint32_t> instance_of_pixel_;
  VoxelIndex voted_;                        ///< instances with outvoted points, whatever their ids
  std::vector<std::uint32_t> voted_label_;  ///< by number in voted_: what those points were given
};
}  // namespace lidar_panoptic_clustering
