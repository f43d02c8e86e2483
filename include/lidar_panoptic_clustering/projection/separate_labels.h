#pragma once

#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A picture as it comes over the wire (sensor_msgs/Image), without its header: a view that owns no data. Row r starts
/// at data + r * step.
struct RawImage
{
  std::uint32_t width = 0, height = 0;
  std::uint32_t step = 0;  ///< bytes
  bool is_bigendian = false;
  std::string encoding;
  const std::uint8_t* data = nullptr;
  std::size_t data_size = 0;  ///< bytes
};

/// Reads a picture of class ids, as networks that work on range images produce them, row-major into `label_of_pixel`.
///
/// Takes one channel of any number type (mono8, 8UC1, 8SC1, mono16, 16UC1, 16SC1, 32SC1, 32FC1, 64FC1) of either byte
/// order, padded rows too; what is no id becomes kUnreadableLabel, see readIds(). A float32 holds ids exactly up to
/// 2^24. The picture must have `rows` x `columns` pixels. Throws std::invalid_argument, with what was
/// expected and found, where it has not, or contradicts itself. Linear in the pixels; the vector's memory is reused.
void readLabelImage(const RawImage& image, std::uint32_t rows, std::uint32_t columns,
                    std::vector<std::uint32_t>& label_of_pixel);

/// Reads the class ids of a second cloud that has the points of `cloud` in the same order: as many rows and columns, or
/// all in one row. Writes them by the points' row-major index.
///
/// `label_field`: any number type, see readIds(); empty for the first of the usual names, see FieldNames. Throws
/// std::invalid_argument when the sizes differ, the field is missing, or as checkLayout() does. Linear in the points;
/// the vector's memory is reused.
void readLabelCloud(const RawCloud& labels, const std::string& label_field, const RawCloud& cloud,
                    std::vector<std::uint32_t>& label_of_point);
}  // namespace lidar_panoptic_clustering
