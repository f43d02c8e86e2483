#include "python/array_views.h"

#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace lidar_panoptic_clustering
{
namespace
{
/// Numbers may lie at any address.
template <class T>
T load(const std::uint8_t* from)
{
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

template <class T>
void copyPoints(const PointsView& view, ScanPoint* to)
{
  const std::ptrdiff_t step = view.channel_step;
  for (std::size_t row = 0; row < view.height; ++row)
  {
    const std::uint8_t* from = view.data + static_cast<std::ptrdiff_t>(row) * view.row_step;
    for (std::size_t column = 0; column < view.width; ++column, from += view.column_step, ++to)
    {
      to->x = static_cast<float>(load<T>(from));
      to->y = static_cast<float>(load<T>(from + step));
      to->z = static_cast<float>(load<T>(from + 2 * step));
      to->remission = view.channels > 3 ? static_cast<float>(load<T>(from + 3 * step)) : 0.0F;
    }
  }
}

template <class T>
void copyIds(const IdsView& view, const std::string& what, std::uint32_t* to)
{
  std::size_t point = 0;
  for (std::size_t row = 0; row < view.height; ++row)
  {
    const std::uint8_t* from = view.data + static_cast<std::ptrdiff_t>(row) * view.row_step;
    for (std::size_t column = 0; column < view.width; ++column, from += view.column_step, ++point)
    {
      const T id = load<T>(from);
      if constexpr (std::is_signed_v<T> || sizeof(T) > 4)
      {
        if (static_cast<std::make_unsigned_t<T>>(id) > std::numeric_limits<std::uint32_t>::max() || id < T{0})
          throw std::invalid_argument(what + ": expected ids from 0 to 4294967295, found " + std::to_string(id) +
                                      " at point " + std::to_string(point));
      }
      to[point] = static_cast<std::uint32_t>(id);
    }
  }
}

template <class Signed>
void copyIdsOf(const IdsView& view, const std::string& what, std::uint32_t* to)
{
  if (view.is_signed)
    copyIds<Signed>(view, what, to);
  else
    copyIds<std::make_unsigned_t<Signed>>(view, what, to);
}
}  // namespace

ScanPoints readPoints(const PointsView& view, std::vector<ScanPoint>& buffer)
{
  const bool packed =
      !view.is_double && view.channels == 4 && view.channel_step == sizeof(float) &&
      view.column_step == sizeof(ScanPoint) &&
      (view.height == 1 || view.row_step == static_cast<std::ptrdiff_t>(view.width * sizeof(ScanPoint))) &&
      reinterpret_cast<std::uintptr_t>(view.data) % alignof(ScanPoint) == 0;
  if (packed) return {reinterpret_cast<const ScanPoint*>(view.data), view.size()};
  buffer.resize(view.size());
  if (view.is_double)
    copyPoints<double>(view, buffer.data());
  else
    copyPoints<float>(view, buffer.data());
  return buffer;
}

void readIds(const IdsView& view, const std::string& what, std::vector<std::uint32_t>& ids)
{
  ids.resize(view.size());
  const bool packed =
      view.bytes == sizeof(std::uint32_t) && !view.is_signed && view.column_step == sizeof(std::uint32_t) &&
      (view.height == 1 || view.row_step == static_cast<std::ptrdiff_t>(view.width * sizeof(std::uint32_t)));
  if (packed && !ids.empty()) std::memcpy(ids.data(), view.data, ids.size() * sizeof(std::uint32_t));
  if (packed) return;
  switch (view.bytes)
  {
    case 1:
      return copyIdsOf<std::int8_t>(view, what, ids.data());
    case 2:
      return copyIdsOf<std::int16_t>(view, what, ids.data());
    case 4:
      return copyIdsOf<std::int32_t>(view, what, ids.data());
    case 8:
      return copyIdsOf<std::int64_t>(view, what, ids.data());
    default:
      throw std::invalid_argument(what + ": expected whole numbers of 1, 2, 4 or 8 bytes, found " +
                                  std::to_string(view.bytes) + " bytes");
  }
}
}  // namespace lidar_panoptic_clustering
