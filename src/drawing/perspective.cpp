#include "drawing/perspective.h"

#include <Eigen/Geometry>

#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kNearest = 0.5, kRadians = 3.14159265358979323846 / 180.0;

void checkSide(const char* name, int value)
{
  if (value < 160 || value > 8192)
    throw std::invalid_argument(std::string("street picture: ") + name + " is " + std::to_string(value) +
                                ", expected 160..8192");
}
}  // namespace

Perspective::Perspective(const StreetPictureOptions& options)
{
  checkSide("width_px", options.width_px);
  checkSide("height_px", options.height_px);
  const Camera& camera = options.camera;
  if (!(camera.field_of_view_deg >= 10.0 && camera.field_of_view_deg <= 150.0))
    throw std::invalid_argument("street picture: field_of_view_deg is " + std::to_string(camera.field_of_view_deg) +
                                ", expected 10 to 150");
  eye_ = {camera.x, camera.y, camera.z};
  ahead_ = Eigen::Vector3d(camera.target_x, camera.target_y, camera.target_z) - eye_;
  if (!(ahead_.head<2>().norm() > 1e-6))
    throw std::invalid_argument("street picture: expected a target beside the eye, found one straight above or below");
  ahead_.normalize();
  right_ = ahead_.cross(Eigen::Vector3d::UnitZ()).normalized();
  down_ = ahead_.cross(right_);
  middle_x_ = 0.5 * options.width_px, middle_y_ = 0.5 * options.height_px;
  focal_px_ = middle_x_ / std::tan(0.5 * camera.field_of_view_deg * kRadians);
}

std::optional<PixelPoint> Perspective::toPixel(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d from_eye = point - eye_;
  const double depth = from_eye.dot(ahead_);
  if (!(depth > kNearest)) return std::nullopt;
  return PixelPoint{middle_x_ + focal_px_ * from_eye.dot(right_) / depth,
                    middle_y_ + focal_px_ * from_eye.dot(down_) / depth};
}
}  // namespace lidar_panoptic_clustering
