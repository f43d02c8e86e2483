#pragma once

#include "lidar_panoptic_clustering/core/instances.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An upright box in the sensor frame.
struct InstanceBox
{
  float x = 0.0F, y = 0.0F, z = 0.0F;                ///< centre [m]
  float length = 0.0F, width = 0.0F, height = 0.0F;  ///< [m], length >= width
  float yaw = 0.0F;                                  ///< of the length axis about z [rad], in (-pi/2, pi/2]
};

/// The smallest box about each instance: in bird's-eye view the rectangle of least area around its points (one of its
/// sides lies along a side of the convex hull: Freeman and Shapira 1975), in height from the lowest to the highest.
///
/// Points inside of the outline in eight directions are left out first (Akl and Toussaint 1978), so that hardly any is
/// sorted; n log n in those that are not. Keeps its memory between scans.
class InstanceBoxes
{
public:
  /// One box an instance, by id - 1; valid until the next call.
  const std::vector<InstanceBox>& fit(const ThingScan& scan, const Instances& instances);

private:
  struct Point
  {
    float x, y;
    bool operator<(const Point& other) const { return x < other.x || (x == other.x && y < other.y); }
  };

  void groupByInstance(const ThingScan& scan, const Instances& instances);
  static Point* dropInside(Point* begin, Point* end);
  void findHull(Point* begin, Point* end);
  void fitRectangle(InstanceBox& box) const;

  std::vector<std::uint32_t> begin_, next_;
  std::vector<Point> points_;  ///< by instance
  std::vector<Point> hull_;    ///< counter-clockwise, of the instance in hand
  std::vector<InstanceBox> boxes_;
};
}  // namespace lidar_panoptic_clustering
