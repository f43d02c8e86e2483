#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
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

void labelPixels(OrganizedScan& scan, const std::vector<std::uint32_t>& label_of_pixel)
{
  const LabelledCloud& cloud = scan.image.cloud;
  if (label_of_pixel.size() != cloud.points.size())
    throw std::invalid_argument("expected " + std::to_string(cloud.height) + " x " + std::to_string(cloud.width) +
                                " labels (rows x columns), one a pixel, found " +
                                std::to_string(label_of_pixel.size()));
  for (std::size_t pixel = 0; pixel < label_of_pixel.size(); ++pixel)
    scan.image.cloud.points[pixel].label = label_of_pixel[pixel];
  for (std::size_t i = 0; i < scan.labels.size(); ++i) scan.labels[i] = label_of_pixel[scan.image.pixel_of_point[i]];
}
}  // namespace lidar_panoptic_clustering
