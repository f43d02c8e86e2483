#pragma once

#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A cloud with fields added: what is new in its message. Width, height and byte order stay.
struct OriginalCloud
{
  std::vector<RawField> fields;
  std::uint32_t point_step = 0, row_step = 0;  ///< bytes; rows are not padded
  std::vector<std::uint8_t> data;
};

/// The number type of the fields added: float32 is what filters of pcl_ros read (PassThrough, ConditionalRemoval). It
/// holds whole numbers exactly up to 2^24, kUnreadableLabel becomes -1.
enum class AddedType
{
  kUint32,
  kFloat32
};

/// The sender's cloud with two more fields a point, `label` and `instance`, everything else of a point as it was, byte
/// for byte.
///
/// A field of that name that is a single number of that type already, and shares no byte with another, is overwritten
/// in place. Where the name is taken by anything else, the new field is called `panoptic_label` or `panoptic_instance`
/// (with as many underscores behind as it takes to be new). New fields stand behind the point's own bytes, at multiples
/// of 4. `label`, `instance`: one a point, row-major. Throws std::invalid_argument when there are not as many as
/// points, as checkSizes() does, for rows beyond 4 GiB, and for ids that a float32 does not hold. Linear; the memory of
/// `out` is reused.
void addLabels(const RawCloud& raw, const std::vector<std::uint32_t>& label, const std::vector<std::uint32_t>& instance,
               OriginalCloud& out, AddedType type = AddedType::kUint32);
}  // namespace lidar_panoptic_clustering
