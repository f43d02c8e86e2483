#include "lidar_panoptic_clustering/projection/original_cloud.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kExactInFloat = 1U << 24U;
constexpr std::size_t kBytes = 4;  // of either type

std::uint8_t codeOf(AddedType type)
{
  return static_cast<std::uint8_t>(type == AddedType::kFloat32 ? NumberType::kFloat32 : NumberType::kUint32);
}

void write(std::uint32_t id, AddedType type, std::uint8_t* to)
{
  if (type == AddedType::kUint32)
  {
    std::memcpy(to, &id, kBytes);
    return;
  }
  if (id > kExactInFloat && id != kUnreadableLabel)
    throw std::invalid_argument("expected ids up to " + std::to_string(kExactInFloat) +
                                ", which a float32 holds exactly, found " + std::to_string(id));
  const float number = id == kUnreadableLabel ? -1.0F : static_cast<float>(id);
  std::memcpy(to, &number, kBytes);
}

/// Where a field of unknown type ends nobody knows: it is taken to reach to the point's end.
bool overlaps(const RawField& field, std::uint64_t begin, std::uint64_t end)
{
  const std::uint64_t size = bytesOfType(field.datatype);
  const std::uint64_t field_end =
      size == 0 ? std::numeric_limits<std::uint64_t>::max() : field.offset + size * std::max(1U, field.count);
  return field.offset < end && begin < field_end;
}

bool canBeOverwritten(const RawCloud& raw, const RawField& field, AddedType type)
{
  const std::uint64_t begin = field.offset, end = begin + kBytes;
  if (field.datatype != codeOf(type) || field.count != 1 || end > raw.point_step) return false;
  for (const auto& other : raw.fields)
    if (&other != &field && overlaps(other, begin, end)) return false;
  return true;
}

/// The offset of a number called `name`: of the sender's own field, or of a new one behind the point.
std::uint32_t placeField(const RawCloud& raw, const std::string& name, AddedType type, OriginalCloud& out)
{
  const RawField* own = findField(raw, name);
  if (own != nullptr && canBeOverwritten(raw, *own, type)) return own->offset;
  std::string free_name = own == nullptr ? name : "panoptic_" + name;
  while (findField(raw, free_name) != nullptr) free_name += '_';
  const std::uint64_t offset = (std::uint64_t{out.point_step} + 3) / 4 * 4;
  if (offset + kBytes > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("expected points of less than 4 GiB, found a point_step of " +
                                std::to_string(raw.point_step) + " bytes");
  out.fields.push_back({free_name, static_cast<std::uint32_t>(offset), codeOf(type), 1});
  out.point_step = static_cast<std::uint32_t>(offset + kBytes);
  return static_cast<std::uint32_t>(offset);
}

void requireOneAPoint(const char* what, std::size_t found, std::size_t points)
{
  if (found != points)
    throw std::invalid_argument("expected " + std::to_string(points) + ' ' + what + ", one a point, found " +
                                std::to_string(found));
}
}  // namespace

void addLabels(const RawCloud& raw, const std::vector<std::uint32_t>& label, const std::vector<std::uint32_t>& instance,
               OriginalCloud& out, AddedType type)
{
  checkSizes(raw);
  const std::size_t size = std::size_t{raw.width} * raw.height;
  requireOneAPoint("labels", label.size(), size);
  requireOneAPoint("instances", instance.size(), size);

  out.fields = raw.fields;
  out.point_step = raw.point_step;
  const std::uint32_t label_offset = placeField(raw, "label", type, out);
  const std::uint32_t instance_offset = placeField(raw, "instance", type, out);
  const std::uint64_t row_step = std::uint64_t{raw.width} * out.point_step;
  if (row_step > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument("expected rows of less than 4 GiB with labels, found " + std::to_string(row_step) +
                                " bytes");
  out.row_step = static_cast<std::uint32_t>(row_step);
  out.data.resize(raw.height * row_step);

  std::uint8_t* to = out.data.data();
  std::size_t i = 0;
  for (std::size_t row = 0; row < raw.height; ++row)
    for (std::size_t column = 0; column < raw.width; ++column, ++i, to += out.point_step)
    {
      std::memcpy(to, raw.point(row, column), raw.point_step);
      std::fill(to + raw.point_step, to + out.point_step, std::uint8_t{0});
      write(label[i], type, to + label_offset);
      write(instance[i], type, to + instance_offset);
    }
}
}  // namespace lidar_panoptic_clustering
