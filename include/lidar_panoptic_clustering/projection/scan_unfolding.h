#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>

namespace lidar_panoptic_clustering
{
/// How a sensor whose points come ring after ring goes along each of them.
struct Sweep
{
  bool clockwise = false;
  float start_rad = 0.0F;  ///< azimuth at which rings begin; of a sector, any in the part that it does not see
};

/// Finds the rings of a scan whose points come ring after ring, as in KITTI's files: there each ring runs
/// counter-clockwise from straight ahead (+x), so a new one starts where the azimuth crosses zero; with another Sweep,
/// where it crosses the sweep's start.
///
/// Rule [Triess et al., "Scan-based semantic segmentation of LiDAR point clouds", IV 2020, section III-A]. KITTI's
/// correction for the car's motion makes close points step back by up to 0.12 rad within their ring, so only a fall of
/// the azimuth by more than 0.3 rad starts a new one, and a point that steps back over zero stays in its ring.
class RingCounter
{
public:
  explicit RingCounter(const Sweep& sweep = {})
      : sense_(sweep.clockwise ? -1.0F : 1.0F), start_(sense_ * sweep.start_rad)
  {
  }

  /// The ring of the next point in file order, from 0. `azimuth` [rad] in [-pi, pi].
  std::uint32_t next(float azimuth)
  {
    float turned = sense_ * azimuth - start_;
    if (turned < 0.0F) turned += kFullTurn;
    const bool fell = turned < last_ - kStep;
    const bool stepped_back_over_zero = last_ < kStep && turned > kFullTurn - kStep;
    if (fell && !before_zero_) ++ring_;
    if (fell)
      before_zero_ = false;
    else if (stepped_back_over_zero)
      before_zero_ = true;
    last_ = turned;
    return ring_;
  }

private:
  static constexpr float kFullTurn = 6.28318530717959F;
  static constexpr float kStep = 0.3F;

  float sense_, start_;
  std::uint32_t ring_ = 0;
  float last_ = 0.0F;         // a scan starts at azimuth zero: a first point just below it has stepped back
  bool before_zero_ = false;  // the ring has begun, but its last point lies before azimuth zero
};
}  // namespace lidar_panoptic_clustering
