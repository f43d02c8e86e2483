#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include "projection/point_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
struct TypeInfo
{
  const char* name;
  std::uint32_t bytes;
};

constexpr TypeInfo kTypes[] = {{"", 0},      {"int8", 1},   {"uint8", 1},   {"int16", 2},  {"uint16", 2},
                               {"int32", 4}, {"uint32", 4}, {"float32", 4}, {"float64", 8}};

bool isNumberType(std::uint8_t datatype)
{
  return datatype >= 1 && datatype <= 8;
}

[[noreturn]] void fail(const std::string& expected, const std::string& found)
{
  throw std::invalid_argument("expected " + expected + ", found " + found);
}

std::string bytes(std::uint64_t n)
{
  return std::to_string(n) + " bytes";
}

template <class T>
T load(const std::uint8_t* from)
{
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

template <class T>
float toFloat(T value)
{
  if constexpr (std::is_same_v<T, double>)
  {
    constexpr double kMax = std::numeric_limits<float>::max();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (value > kMax) return kInfinity;
    if (value < -kMax) return -kInfinity;
  }
  return static_cast<float>(value);
}

template <class T>
std::uint32_t toId(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    // written so that NaN fails it; 2^32 is the first value that does not fit
    if (!(value >= 0 && value < static_cast<T>(4294967296.0)) || value != std::floor(value)) return kUnreadableLabel;
  }
  else if constexpr (std::is_signed_v<T>)
  {
    if (value < 0) return kUnreadableLabel;
  }
  return static_cast<std::uint32_t>(value);
}

template <class T, class Out, class Convert>
void readRun(const PointRun& run, std::uint32_t offset, Out* out, std::size_t out_step, Convert convert)
{
  const std::uint8_t* from = run.first + offset;
  auto* to = reinterpret_cast<std::uint8_t*>(out);
  for (std::size_t i = 0; i < run.count; ++i, from += run.step, to += out_step)
  {
    const Out value = convert(load<T>(from));
    std::memcpy(to, &value, sizeof(Out));
  }
}

/// The one place where a type code becomes a type: the loop over the points is inside of it.
template <class Out, class Convert>
void readAs(const PointRun& run, const RawField& field, Out* out, std::size_t out_step, Convert convert)
{
  switch (field.type())
  {
    case NumberType::kInt8:
      return readRun<std::int8_t>(run, field.offset, out, out_step, convert);
    case NumberType::kUint8:
      return readRun<std::uint8_t>(run, field.offset, out, out_step, convert);
    case NumberType::kInt16:
      return readRun<std::int16_t>(run, field.offset, out, out_step, convert);
    case NumberType::kUint16:
      return readRun<std::uint16_t>(run, field.offset, out, out_step, convert);
    case NumberType::kInt32:
      return readRun<std::int32_t>(run, field.offset, out, out_step, convert);
    case NumberType::kUint32:
      return readRun<std::uint32_t>(run, field.offset, out, out_step, convert);
    case NumberType::kFloat32:
      return readRun<float>(run, field.offset, out, out_step, convert);
    case NumberType::kFloat64:
      return readRun<double>(run, field.offset, out, out_step, convert);
  }
}

/// Calls `read(run, index of its first point in the output)` for pieces of the cloud that follow one another both in
/// the input, `step` apart, and in the output; small enough that all fields of a piece are read from the cache.
template <class Read>
void forEachRun(const RawCloud& raw, RowOrder order, Read read)
{
  if (raw.width == 0 || raw.height == 0) return;
  if (order == RowOrder::kAsSent)
  {
    constexpr std::size_t kRun = 256;
    for (std::size_t row = 0; row < raw.height; ++row)
      for (std::size_t column = 0; column < raw.width; column += kRun)
        read(PointRun{raw.point(row, column), raw.point_step, std::min(kRun, raw.width - column)},
             row * raw.width + column);
    return;
  }
  constexpr std::size_t kRun = 16;
  for (std::size_t row = 0; row < raw.height; row += kRun)
    for (std::size_t column = 0; column < raw.width; ++column)
      read(PointRun{raw.point(row, column), raw.row_step, std::min(kRun, raw.height - row)}, column * raw.height + row);
}

template <class Cloud>
void resize(const RawCloud& raw, RowOrder order, Cloud& cloud)
{
  const bool as_sent = order == RowOrder::kAsSent;
  cloud.points.resize(std::size_t{raw.width} * raw.height);
  cloud.width = as_sent ? raw.width : raw.height;
  cloud.height = as_sent ? raw.height : raw.width;
  cloud.is_dense = false;
}
}  // namespace

std::string describeFields(const RawCloud& cloud)
{
  std::string text;
  for (const auto& field : cloud.fields)
  {
    text += text.empty() ? "" : ", ";
    text += field.name + ' ';
    text += isNumberType(field.datatype) ? kTypes[field.datatype].name : "datatype " + std::to_string(field.datatype);
    if (field.count != 1) text += '[' + std::to_string(field.count) + ']';
  }
  return text.empty() ? "no fields" : text;
}

std::uint32_t bytesOfType(std::uint8_t datatype)
{
  return isNumberType(datatype) ? kTypes[datatype].bytes : 0;
}

const RawField* findField(const RawCloud& cloud, const std::string& name)
{
  for (const auto& field : cloud.fields)
    if (field.name == name) return &field;
  return nullptr;
}

/// Widths, heights and steps are 32-bit numbers, so that no product of two of them overflows 64 bits.
void checkSizes(const RawCloud& cloud)
{
  if (cloud.is_bigendian) fail("little-endian data", "is_bigendian = true");

  const std::uint64_t row_bytes = std::uint64_t{cloud.width} * cloud.point_step;
  const std::uint64_t all_bytes = std::uint64_t{cloud.height} * cloud.row_step;
  if (cloud.width > 0 && cloud.height > 0)
  {
    if (cloud.point_step == 0) fail("a point_step above 0", "0");
    if (cloud.row_step < row_bytes)
      fail("a row_step of at least width * point_step = " + std::to_string(cloud.width) + " * " +
               bytes(cloud.point_step),
           bytes(cloud.row_step));
  }
  else if (std::max(cloud.width, cloud.height) > kMaxEmptySide)
  {
    fail("at most " + std::to_string(kMaxEmptySide) + " rows or columns in an empty cloud",
         std::to_string(cloud.width) + " x " + std::to_string(cloud.height));
  }
  if (cloud.data_size != all_bytes)
    fail("data of height * row_step = " + std::to_string(cloud.height) + " * " + bytes(cloud.row_step),
         bytes(cloud.data_size));
}

void checkField(const RawCloud& cloud, const RawField& field)
{
  const std::string which = "field '" + field.name + "' ";
  if (!isNumberType(field.datatype))
    fail(which + "of a datatype from 1 (int8) to 8 (float64)", "datatype " + std::to_string(field.datatype));
  if (field.count == 0) fail(which + "with a count of at least 1", "count 0");

  const std::uint64_t size = std::uint64_t{kTypes[field.datatype].bytes} * field.count;
  if (field.offset + size > cloud.point_step)
    fail(which + "inside the point of " + bytes(cloud.point_step),
         bytes(size) + " at offset " + std::to_string(field.offset));
}

void checkLayout(const RawCloud& cloud, const std::vector<std::string>& required,
                 const std::vector<std::string>& optional)
{
  checkSizes(cloud);
  for (const auto& name : required)
  {
    const RawField* field = findField(cloud, name);
    if (field == nullptr) fail("a field '" + name + "'", describeFields(cloud));
    checkField(cloud, *field);
  }
  for (const auto& name : optional)
    if (const RawField* field = findField(cloud, name)) checkField(cloud, *field);
}

void readFloats(const PointRun& run, const RawField& field, float* out, std::size_t out_step)
{
  readAs(run, field, out, out_step, [](auto value) { return toFloat(value); });
}

void readIds(const PointRun& run, const RawField& field, std::uint32_t* out, std::size_t out_step)
{
  readAs(run, field, out, out_step, [](auto value) { return toId(value); });
}

void readLabelled(const RawCloud& raw, const LabelledFields& names, LabelledCloud& cloud, RowOrder order)
{
  checkLayout(raw, {names.x, names.y, names.z, names.label}, {names.intensity});
  resize(raw, order, cloud);
  const PointReader<LabelledPoint> reader(raw, names);
  forEachRun(raw, order, [&](const PointRun& run, std::size_t first) { reader.read(run, &cloud.points[first]); });
}

void readPanoptic(const RawCloud& raw, PanopticCloud& cloud)
{
  const LabelledFields names;
  checkLayout(raw, {names.x, names.y, names.z, names.label, "instance"}, {names.intensity, "rgb"});
  resize(raw, RowOrder::kAsSent, cloud);
  const PointReader<PanopticPoint> reader(raw, names);
  const RawField& instance = *findField(raw, "instance");
  const RawField* rgb = findField(raw, "rgb");
  RawField rgb_bits;
  if (rgb != nullptr)
  {
    rgb_bits = *rgb;
    if (rgb->type() == NumberType::kFloat32) rgb_bits.datatype = static_cast<std::uint8_t>(NumberType::kUint32);
  }
  forEachRun(raw, RowOrder::kAsSent,
             [&](const PointRun& run, std::size_t first)
             {
               PanopticPoint* out = &cloud.points[first];
               reader.read(run, out);
               readIds(run, instance, &out->instance, sizeof(PanopticPoint));
               for (std::size_t i = 0; i < run.count; ++i)
                 if (out[i].instance == kUnreadableLabel) out[i].instance = 0;
               if (rgb != nullptr)
                 readIds(run, rgb_bits, &out->rgb, sizeof(PanopticPoint));
               else
                 for (std::size_t i = 0; i < run.count; ++i) out[i].rgb = 0;
             });
}
}  // namespace lidar_panoptic_clustering
