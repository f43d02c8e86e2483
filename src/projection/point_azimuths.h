#pragma once

#include "lidar_panoptic_clustering/projection/azimuth.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace lidar_panoptic_clustering
{
/// fastAzimuth() and hasDirection() of four points at a time, the same to the bit, as one instruction works on four.
class FourAzimuths
{
public:
  /// `points`: four of them.
  explicit FourAzimuths(const ScanPoint* points)
  {
    constexpr float pi = 3.14159265358979F, infinity = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
    const Floats x = {points[0].x, points[1].x, points[2].x, points[3].x};
    const Floats y = {points[0].y, points[1].y, points[2].y, points[3].y};
    const Floats z = {points[0].z, points[1].z, points[2].z, points[3].z};
    const Floats squared_range = x * x + y * y + z * z;
    const Floats ax = magnitude(x), ay = magnitude(y);
    const Ints steep = ay > ax;
    const Floats larger = choose(steep, ay, ax), smaller = choose(steep, ax, ay);
    const Floats t = choose(larger > 0.0F, smaller / larger, Floats{});
    const Floats s = t * t;
    const Floats series = 0.19354346F + s * (-0.11643287F + s * (0.05265332F - s * 0.01172120F));
    Floats angle = t * (0.99997726F + s * (-0.33262347F + s * series));
    angle = choose(steep, pi / 2 - angle, angle);
    angle = choose(x < 0.0F, pi - angle, angle);
    angle = choose(y < 0.0F, -angle, angle);
    const Ints has_direction = (squared_range > 0.0F) & (squared_range < infinity);
    azimuth_ = choose(has_direction, angle, Floats{} + nan);
    squared_range_ = squared_range;
  }

  float azimuth(int i) const { return azimuth_[i]; }             ///< of the i-th point; NaN where there is no return
  float squaredRange(int i) const { return squared_range_[i]; }  ///< of the i-th point

private:
  using Floats = float __attribute__((vector_size(16)));
  using Ints = std::int32_t __attribute__((vector_size(16)));

  static Floats choose(Ints which, Floats yes, Floats no)
  {
    return reinterpret_cast<Floats>((which & reinterpret_cast<Ints>(yes)) | (~which & reinterpret_cast<Ints>(no)));
  }
  static Floats magnitude(Floats a) { return reinterpret_cast<Floats>(reinterpret_cast<Ints>(a) & 0x7FFFFFFF); }

  Floats azimuth_, squared_range_;
};

/// Calls `take(i, azimuth, squared_range)` for each point in turn; the azimuth is NaN where it has none.
template <class Take>
void forEachAzimuth(ScanPoints scan, Take take)
{
  std::size_t i = 0;
  for (; i + 4 <= scan.size(); i += 4)
  {
    const FourAzimuths four(&scan[i]);
    for (int k = 0; k < 4; ++k) take(i + static_cast<std::size_t>(k), four.azimuth(k), four.squaredRange(k));
  }
  ScanPoint rest[4] = {};
  std::copy(scan.begin() + i, scan.end(), rest);
  const FourAzimuths four(rest);
  for (int k = 0; i < scan.size(); ++i, ++k) take(i, four.azimuth(k), four.squaredRange(k));
}
}  // namespace lidar_panoptic_clustering
