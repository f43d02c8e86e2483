#pragma once

#include "drawing/canvas.h"
#include "lidar_panoptic_clustering/drawing/street_picture.h"

#include <Eigen/Core>

#include <optional>

namespace lidar_panoptic_clustering
{
/// A pinhole camera that stands upright.
class Perspective
{
public:
  /// Throws as drawStreetPicture does.
  explicit Perspective(const StreetPictureOptions& options);

  /// Along the line of sight [m].
  double depth(const Eigen::Vector3d& point) const { return (point - eye_).dot(ahead_); }
  /// Where a point is seen; nothing where it lies nearer than half a metre or behind the eye.
  std::optional<PixelPoint> toPixel(const Eigen::Vector3d& point) const;
  /// How long a metre is at a depth of one metre [px].
  double focalLength() const { return focal_px_; }

private:
  Eigen::Vector3d eye_, ahead_, right_, down_;
  double focal_px_, middle_x_, middle_y_;
};
}  // namespace lidar_panoptic_clustering
