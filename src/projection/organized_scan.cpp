#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr int kRows = 2, kColumns = 2;  // at least as near as HiddenPointLabeller looks for instances
constexpr float kFullTurn = 6.28318530717959F;

/// The returns that the image of a scan shows, over the wrap.
class ShownPoints
{
public:
  explicit ShownPoints(const LabelledCloud& cloud)
      : cloud_(cloud), width_(static_cast<int>(cloud.width)), height_(static_cast<int>(cloud.height))
  {
  }

  std::uint32_t labelNear(const ScanPoint& point, std::uint32_t pixel, std::uint32_t no_class) const
  {
    const float range = std::hypot(point.x, point.y);
    const float spacing = range * kFullTurn / static_cast<float>(width_);
    const float limit = std::min(kMostM, std::max(kLeastM, kLimitColumns * spacing));
    float least = limit * limit;  // NaN without a return: nothing is near
    std::uint32_t nearest = no_class;
    const int row = static_cast<int>(pixel) / width_, column = static_cast<int>(pixel) % width_;
    const int last_row = std::min(height_ - 1, row + kRows), columns = std::min(kColumns, (width_ - 1) / 2);
    for (int r = std::max(0, row - kRows); r <= last_row; ++r)
      for (int c = column - columns; c <= column + columns; ++c)
      {
        const LabelledPoint& shown = cloud_.points[static_cast<std::size_t>(r * width_ + (c + width_) % width_)];
        const float dx = shown.x - point.x, dy = shown.y - point.y, dz = shown.z - point.z;
        const float squared_distance = dx * dx + dy * dy + dz * dz;
        if (!(squared_distance < least)) continue;
        least = squared_distance, nearest = shown.label;
      }
    return nearest;
  }

private:
  // by the last one no object grows by more than that
  static constexpr float kLeastM = 0.1F, kLimitColumns = 2.0F, kMostM = 0.2F;

  const LabelledCloud& cloud_;
  int width_, height_;
};
}  // namespace

void labelPoints(OrganizedScan& scan, const std::vector<std::uint32_t>& label_of_point)
{
  if (label_of_point.size() != scan.points.size())
    throw std::invalid_argument("expected " + std::to_string(scan.points.size()) + " labels, one a point, found " +
                                std::to_string(label_of_point.size()));
  scan.labels = label_of_point;
  auto& pixels = scan.image.cloud.points;
  if (scan.organized_input)  // a pixel without a return shows its point's label too
  {
    for (std::size_t i = 0; i < label_of_point.size(); ++i)
      pixels[scan.image.pixel_of_point[i]].label = label_of_point[i];
    return;
  }
  for (std::size_t pixel = 0; pixel < pixels.size(); ++pixel)
  {
    const std::uint32_t owner = scan.image.owner_of_pixel[pixel];
    pixels[pixel].label = owner == Projection::kNone ? 0 : label_of_point[owner];
  }
}

void labelPixels(OrganizedScan& scan, const std::vector<std::uint32_t>& label_of_pixel, std::uint32_t no_class)
{
  const LabelledCloud& cloud = scan.image.cloud;
  if (label_of_pixel.size() != cloud.points.size())
    throw std::invalid_argument("expected " + std::to_string(cloud.height) + " x " + std::to_string(cloud.width) +
                                " labels (rows x columns), one a pixel, found " +
                                std::to_string(label_of_pixel.size()));
  for (std::size_t pixel = 0; pixel < label_of_pixel.size(); ++pixel)
    scan.image.cloud.points[pixel].label = label_of_pixel[pixel];
  const ShownPoints shown(cloud);
  for (std::uint32_t i = 0; i < scan.labels.size(); ++i)
  {
    const std::uint32_t pixel = scan.image.pixel_of_point[i];
    const bool is_shown = scan.organized_input || scan.image.owner_of_pixel[pixel] == i;
    scan.labels[i] = is_shown ? label_of_pixel[pixel] : shown.labelNear(scan.points[i], pixel, no_class);
  }
}
}  // namespace lidar_panoptic_clustering
