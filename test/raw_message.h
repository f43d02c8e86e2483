#pragma once

#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <cstring>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
inline std::uint32_t bytesOf(NumberType type)
{
  switch (type)
  {
    case NumberType::kInt8:
    case NumberType::kUint8:
      return 1;
    case NumberType::kInt16:
    case NumberType::kUint16:
      return 2;
    case NumberType::kFloat64:
      return 8;
    default:
      return 4;
  }
}

/// A message's bytes and description, to be filled by hand: what a RawCloud views.
struct RawMessage
{
  RawCloud header;
  std::vector<std::uint8_t> bytes;

  RawMessage(std::uint32_t height, std::uint32_t width, std::vector<RawField> fields, std::uint32_t point_step,
             std::uint32_t row_padding = 0)
  {
    header.height = height;
    header.width = width;
    header.fields = std::move(fields);
    header.point_step = point_step;
    header.row_step = width * point_step + row_padding;
    bytes.assign(std::size_t{height} * header.row_step, 0xAB);  // padding is not zero
  }

  RawCloud view() const
  {
    RawCloud cloud = header;
    cloud.data = bytes.data();
    cloud.data_size = bytes.size();
    return cloud;
  }

  void set(std::size_t row, std::size_t column, const std::string& name, double value)
  {
    const RawField& field = *findField(header, name);
    std::uint8_t* to = &bytes[row * header.row_step + column * header.point_step + field.offset];
    switch (field.type())
    {
      case NumberType::kInt8:
        return store<std::int8_t>(to, value);
      case NumberType::kUint8:
        return store<std::uint8_t>(to, value);
      case NumberType::kInt16:
        return store<std::int16_t>(to, value);
      case NumberType::kUint16:
        return store<std::uint16_t>(to, value);
      case NumberType::kInt32:
        return store<std::int32_t>(to, value);
      case NumberType::kUint32:
        return store<std::uint32_t>(to, value);
      case NumberType::kFloat32:
        return store<float>(to, value);
      case NumberType::kFloat64:
        return store<double>(to, value);
    }
  }

  void setPoint(std::size_t row, std::size_t column, double x, double y, double z)
  {
    set(row, column, "x", x);
    set(row, column, "y", y);
    set(row, column, "z", z);
  }

private:
  template <class T>
  static void store(std::uint8_t* to, double value)
  {
    const T stored = static_cast<T>(value);
    std::memcpy(to, &stored, sizeof(T));
  }
};

inline RawField rawField(const std::string& name, std::uint32_t offset, NumberType type, std::uint32_t count = 1)
{
  return {name, offset, static_cast<std::uint8_t>(type), count};
}

/// Fields one behind the other without gaps; `point_step` becomes their end.
inline std::vector<RawField> packed(std::initializer_list<std::pair<const char*, NumberType>> list,
                                    std::uint32_t& point_step)
{
  std::vector<RawField> fields;
  point_step = 0;
  for (const auto& [name, type] : list)
  {
    fields.push_back(rawField(name, point_step, type));
    point_step += bytesOf(type);
  }
  return fields;
}

/// Two rows of three points with x y z float32 and label uint32, point (r, c) at (10 r + c, 0.5, -1) and label r + c.
inline RawMessage simpleMessage(std::uint32_t row_padding = 0)
{
  std::uint32_t step = 0;
  auto fields = packed({{"x", NumberType::kFloat32},
                        {"y", NumberType::kFloat32},
                        {"z", NumberType::kFloat32},
                        {"label", NumberType::kUint32}},
                       step);
  RawMessage message(2, 3, fields, step, row_padding);
  for (unsigned r = 0; r < 2; ++r)
    for (unsigned c = 0; c < 3; ++c)
    {
      message.setPoint(r, c, 10.0 * r + c, 0.5, -1.0);
      message.set(r, c, "label", r + c);
    }
  return message;
}

/// The same scan with rows and columns exchanged.
inline RawMessage transposed(const RawMessage& message)
{
  const RawCloud& h = message.header;
  RawMessage result(h.width, h.height, h.fields, h.point_step);
  for (std::size_t row = 0; row < h.height; ++row)
    for (std::size_t column = 0; column < h.width; ++column)
      std::memcpy(&result.bytes[column * result.header.row_step + row * h.point_step],
                  &message.bytes[row * h.row_step + column * h.point_step], h.point_step);
  return result;
}

/// What `function` throws as std::invalid_argument; "" when nothing.
template <class Function>
std::string errorOf(Function function)
{
  try
  {
    function();
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "";
}
}  // namespace lidar_panoptic_clustering
