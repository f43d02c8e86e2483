#include "lidar_panoptic_clustering/projection/separate_labels.h"

#include "lidar_panoptic_clustering/projection/scan_fields.h"

#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
struct Encoding
{
  const char* name;
  NumberType type;  ///< signed ids are read as bits and judged after their bytes are in order
  std::uint32_t bytes;
  bool is_signed;
};

constexpr Encoding kEncodings[] = {{"mono8", NumberType::kUint8, 1, false},
                                   {"8UC1", NumberType::kUint8, 1, false},
                                   {"mono16", NumberType::kUint16, 2, false},
                                   {"16UC1", NumberType::kUint16, 2, false},
                                   {"32SC1", NumberType::kUint32, 4, true}};

[[noreturn]] void fail(const std::string& expected, const std::string& found)
{
  throw std::invalid_argument("expected " + expected + ", found " + found);
}

std::string size(std::uint32_t rows, std::uint32_t columns)
{
  return std::to_string(rows) + " rows x " + std::to_string(columns) + " columns";
}

const Encoding& encodingOf(const RawImage& image)
{
  std::string names;
  for (const Encoding& encoding : kEncodings)
  {
    if (image.encoding == encoding.name) return encoding;
    names += (names.empty() ? "" : ", ") + std::string(encoding.name);
  }
  fail("a label image of encoding " + names, "'" + image.encoding + "'");
}

std::uint32_t swapBytes(std::uint32_t value, std::uint32_t bytes)
{
  if (bytes == 2) return (value & 0xFFU) << 8U | value >> 8U;
  return value << 24U | (value & 0xFF00U) << 8U | (value >> 8U & 0xFF00U) | value >> 24U;
}
}  // namespace

void readLabelImage(const RawImage& image, std::uint32_t rows, std::uint32_t columns,
                    std::vector<std::uint32_t>& label_of_pixel)
{
  const Encoding& encoding = encodingOf(image);
  if (image.height != rows || image.width != columns)
    fail("a label image of the range image's " + size(rows, columns), size(image.height, image.width));
  const std::uint64_t row_bytes = std::uint64_t{image.width} * encoding.bytes;
  const std::uint64_t all_bytes = std::uint64_t{image.height} * image.step;
  if (image.step < row_bytes)
    fail("a label image whose step is at least " + std::to_string(row_bytes) + " bytes", std::to_string(image.step));
  if (image.data_size != all_bytes)
    fail("a label image with height * step = " + std::to_string(all_bytes) + " bytes", std::to_string(image.data_size));

  label_of_pixel.resize(std::size_t{rows} * columns);
  const RawField whole_pixel{"id", 0, static_cast<std::uint8_t>(encoding.type), 1};
  for (std::size_t row = 0; row < rows; ++row)
    readIds({image.data + row * image.step, encoding.bytes, columns}, whole_pixel,
            label_of_pixel.data() + row * columns, sizeof(std::uint32_t));
  if (image.is_bigendian && encoding.bytes > 1)
    for (std::uint32_t& label : label_of_pixel) label = swapBytes(label, encoding.bytes);
  if (encoding.is_signed)
    for (std::uint32_t& label : label_of_pixel)
      if (label > 0x7FFFFFFFU) label = kUnreadableLabel;
}

void readLabelCloud(const RawCloud& labels, const std::string& label_field, const RawCloud& cloud,
                    std::vector<std::uint32_t>& label_of_point)
{
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  const bool same_shape = labels.width == cloud.width && labels.height == cloud.height;
  const bool one_row = labels.height == 1 && labels.width == points;
  if (!same_shape && !one_row)
    fail("a label cloud with the cloud's points in the same order, " + size(cloud.height, cloud.width) +
             " or all in one row",
         size(labels.height, labels.width));
  checkSizes(labels);
  const RawField& field = findLabelField(labels, label_field);
  checkField(labels, field);

  label_of_point.resize(points);
  for (std::size_t row = 0; row < labels.height && points > 0; ++row)
    readIds({labels.point(row, 0), labels.point_step, labels.width}, field, label_of_point.data() + row * labels.width,
            sizeof(std::uint32_t));
}
}  // namespace lidar_panoptic_clustering
