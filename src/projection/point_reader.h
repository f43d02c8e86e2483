#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace lidar_panoptic_clustering
{
/// Reads what LabelledPoint and PanopticPoint, the two types of `Point`, have in common. The cloud and its layout must
/// have been checked, see checkLayout(), and outlive the reader.
///
/// A sender of this package, in another process, has its points on the wire as they lie in memory: they are copied
/// whole, in about a third of the time.
template <class Point>
class PointReader
{
public:
  PointReader(const RawCloud& raw, const LabelledFields& names)
      : x_(*findField(raw, names.x)),
        y_(*findField(raw, names.y)),
        z_(*findField(raw, names.z)),
        label_(*findField(raw, names.label)),
        intensity_(findField(raw, names.intensity)),
        as_in_memory_(liesAt(x_, NumberType::kFloat32, offsetof(Point, x)) &&
                      liesAt(y_, NumberType::kFloat32, offsetof(Point, y)) &&
                      liesAt(z_, NumberType::kFloat32, offsetof(Point, z)) &&
                      liesAt(label_, NumberType::kUint32, offsetof(Point, label)) && intensity_ != nullptr &&
                      liesAt(*intensity_, NumberType::kFloat32, offsetof(Point, intensity)))
  {
  }

  /// Sets all of the points but what PanopticPoint alone has.
  void read(const PointRun& run, Point* out) const
  {
    if (as_in_memory_ && run.step == sizeof(Point)) return copyWhole(run, out);
    readFloats(run, x_, &out->x, sizeof(Point));
    readFloats(run, y_, &out->y, sizeof(Point));
    readFloats(run, z_, &out->z, sizeof(Point));
    readIds(run, label_, &out->label, sizeof(Point));
    if (intensity_ != nullptr)
      readFloats(run, *intensity_, &out->intensity, sizeof(Point));
    else
      for (std::size_t i = 0; i < run.count; ++i) out[i].intensity = 0.0F;
  }

private:
  static bool liesAt(const RawField& field, NumberType type, std::size_t offset)
  {
    return field.type() == type && field.offset == offset;
  }

  static void copyWhole(const PointRun& run, Point* out)
  {
    static_assert(std::is_trivially_copyable_v<Point>);
    std::memcpy(static_cast<void*>(out), run.first, run.count * sizeof(Point));
    for (std::size_t i = 0; i < run.count; ++i) out[i].data[3] = 1.0F;  // padding on the wire, for Eigen it is not
  }

  const RawField &x_, &y_, &z_, &label_;
  const RawField* intensity_;
  bool as_in_memory_;
};
}  // namespace lidar_panoptic_clustering
