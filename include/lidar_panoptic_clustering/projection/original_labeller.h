#pragma once

#include "lidar_panoptic_clustering/projection/hidden_points.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"

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
  /// `table`: the classes that were clustered with.
  explicit OriginalLabeller(std::shared_ptr<const ClassTable> table);

  /// `clustered`: what a FramePipeline painted of scan.image.cloud. Of that cloud only the size is used here, so that
  /// its points may have been moved on.
  ///
  /// Writes a label and an instance a point, by sent index. A point that its pixel shows gets the pixel's; a hidden one
  /// the instance it belongs to as HiddenPointLabeller has it, and the class that instance was voted to have, its own
  /// where nothing was voted. Throws std::invalid_argument when the sizes contradict each other. Linear.
  void carryBack(const OrganizedScan& scan, const PanopticCloud& clustered, std::vector<std::uint32_t>& label,
                 std::vector<std::uint32_t>& instance);

private:
  void takeVotes(const OrganizedScan& scan, const PanopticCloud& clustered);

  std::shared_ptr<const ClassTable> table_;
  HiddenPointLabeller hidden_points_;
  std::vector<std::uint32_t> instance_of_pixel_;
  std::vector<std::uint32_t> voted_label_;  ///< by instance: what its outvoted points were given, kNoVote for none
};
}  // namespace lidar_panoptic_clustering
