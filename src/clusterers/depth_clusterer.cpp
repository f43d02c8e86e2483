#include "lidar_panoptic_clustering/clusterers/depth_clusterer.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;
}  // namespace

DepthClusterer::DepthClusterer(const DepthConfig& config)
{
  validateParameters(config);
  requireOffOrDistance("max_distance_m", config.max_distance_m, 100.0);
  const double tan_theta = std::tan(config.theta_deg * kRadiansPerDegree);
  squared_tan_theta_ = static_cast<float>(tan_theta * tan_theta);
  max_squared_distance_ = config.max_distance_m > 0.0
                              ? static_cast<float>(config.max_distance_m * config.max_distance_m)
                              : std::numeric_limits<float>::infinity();
  max_gap_px_ = static_cast<std::uint32_t>(config.max_gap_px);
}

void DepthClusterer::cluster(const ThingScan& scan, std::vector<std::uint32_t>& component)
{
  looked_at_ = 0;
  sets_.reset(scan.size());
  linkAlongLines(scan);
  linkAlongColumns(scan);
  sets_.flatten(component);
}

/// The same in either order of the two, and without a branch on which is the farther: on a surface that is a coin toss.
void DepthClusterer::link(const ThingScan& scan, std::uint32_t i, std::uint32_t j)
{
  ++looked_at_;
  const ThingPoint &a = scan.points[i], &b = scan.points[j];
  const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  const float squared_distance = dx * dx + dy * dy + dz * dz;
  const float link_distance = scan.linkDistance(i, j);
  if (squared_distance > max_squared_distance_ || squared_distance >= link_distance * link_distance) return;
  const float sx = a.x + b.x, sy = a.y + b.y, sz = a.z + b.z;  // (A + B) x D = 2 A x D
  const float cx = sy * dz - sz * dy, cy = sz * dx - sx * dz, cz = sx * dy - sy * dx;
  const float dot = std::max(a.x * dx + a.y * dy + a.z * dz, -(b.x * dx + b.y * dy + b.z * dz));  // the farther's
  if (cx * cx + cy * cy + cz * cz > 4.0F * squared_tan_theta_ * dot * dot || squared_distance == 0.0F)
    sets_.unite(i, j);
}

void DepthClusterer::linkAlongLines(const ThingScan& scan)
{
  for (std::uint32_t row = 0; row < scan.rows; ++row)
  {
    last_.assign(scan.link_count, {kNone, 0});
    first_.assign(scan.link_count, {kNone, 0});
    for (std::uint32_t i = scan.line_begin[row]; i < scan.line_begin[row + 1]; ++i)
    {
      const std::uint32_t column = scan.points[i].column;
      Last& last = last_[scan.link[i]];
      if (last.point == kNone)
        first_[scan.link[i]] = {i, column};
      else if (column - last.position <= max_gap_px_)
        link(scan, i, last.point);
      last = {i, column};
    }
    if (!scan.full_turn) continue;
    for (std::uint32_t key = 0; key < scan.link_count; ++key)
      if (last_[key].point != kNone && first_[key].position + scan.columns - last_[key].position <= max_gap_px_)
        link(scan, last_[key].point, first_[key].point);
  }
}

void DepthClusterer::linkAlongColumns(const ThingScan& scan)
{
  last_above_.assign(static_cast<std::size_t>(scan.columns) * scan.link_count, {kNone, 0});
  for (std::uint32_t row = 0; row < scan.rows; ++row)
    for (std::uint32_t i = scan.line_begin[row]; i < scan.line_begin[row + 1]; ++i)
    {
      Last& above = last_above_[static_cast<std::size_t>(scan.points[i].column) * scan.link_count + scan.link[i]];
      if (above.point != kNone && row - above.position <= max_gap_px_) link(scan, i, above.point);
      above = {i, row};
    }
}
}  // namespace lidar_panoptic_clustering
