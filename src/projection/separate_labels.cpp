#include "lidar_panoptic_clustering/projection/separate_labels.h"

#include "lidar_panoptic_clustering/projection/scan_fields.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
struct Encoding
{
  const char* name;
  NumberType type;
};

/// Of sensor_msgs/image_encodings; unsigned 32-bit numbers have none.
constexpr Encoding kEncodings[] = {
    {"mono8", NumberType::kUint8},   {"8UC1", NumberType::kUint8},    {"8SC1", NumberType::kInt8},
    {"mono16", NumberType::kUint16}, {"16UC1", NumberType::kUint16},  {"16SC1", NumberType::kInt16},
    {"32SC1", NumberType::kInt32},   {"32FC1", NumberType::kFloat32}, {"64FC1", NumberType::kFloat64}};

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

/// Reads `count` ids of the other byte order.
void readSwapped(const std::uint8_t* from, const RawField& field, std::size_t count, std::uint32_t* ids)
{
  constexpr std::size_t kRun = 128;
  std::array<std::uint8_t, kRun * sizeof(double)> swapped;
  const std::size_t bytes = bytesOfType(field.datatype);
  for (std::size_t begin = 0; begin < count; begin += kRun)
  {
    const std::size_t run = std::min(kRun, count - begin);
    for (std::size_t i = 0; i < run; ++i)
      std::reverse_copy(from + (begin + i) * bytes, from + (begin + i + 1) * bytes, &swapped[i * bytes]);
    readIds({swapped.data(), bytes, run}, field, ids + begin, sizeof(std::uint32_t));
  }
}
}  // namespace

void readLabelImage(const RawImage& image, std::uint32_t rows, std::uint32_t columns,
                    std::vector<std::uint32_t>& label_of_pixel)
{
  const Encoding& encoding = encodingOf(image);
  if (image.height != rows || image.width != columns)
    fail("a label image of the range image's " + size(rows, columns), size(image.height, image.width));
  const RawField whole_pixel{"id", 0, static_cast<std::uint8_t>(encoding.type), 1};
  const std::uint32_t bytes = bytesOfType(whole_pixel.datatype);
  const std::uint64_t row_bytes = std::uint64_t{image.width} * bytes;
  const std::uint64_t all_bytes = std::uint64_t{image.height} * image.step;
  if (image.step < row_bytes)
    fail("a label image whose step is at least " + std::to_string(row_bytes) + " bytes", std::to_string(image.step));
  if (image.data_size != all_bytes)
    fail("a label image with height * step = " + std::to_string(all_bytes) + " bytes", std::to_string(image.data_size));

  label_of_pixel.resize(std::size_t{rows} * columns);
  for (std::size_t row = 0; row < rows; ++row)
  {
    const std::uint8_t* from = image.data + row * image.step;
    std::uint32_t* ids = label_of_pixel.data() + row * columns;
    if (image.is_bigendian)
      readSwapped(from, whole_pixel, columns, ids);
    else
      readIds({from, bytes, columns}, whole_pixel, ids, sizeof(std::uint32_t));
  }
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
