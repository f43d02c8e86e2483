#include "lidar_panoptic_clustering/projection/point_projection.h"

#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/azimuth.h"
#include "lidar_panoptic_clustering/projection/scan_unfolding.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kPi = 3.14159265358979F;

LabelledPoint noReturn()
{
  LabelledPoint point;
  point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
  return point;
}
}  // namespace

PointProjector::PointProjector(const ProjectionConfig& config)
    : rows_(static_cast<std::uint32_t>(config.rows)), columns_(static_cast<std::uint32_t>(config.columns))
{
  validateParameters(config);
}

void PointProjector::project(const std::vector<ScanPoint>& scan, const std::vector<std::uint32_t>& labels,
                             Projection& out)
{
  if (!labels.empty() && labels.size() != scan.size())
    throw std::invalid_argument("expected one label a point, found " + std::to_string(labels.size()) + " labels for " +
                                std::to_string(scan.size()) + " points");
  locate(scan, out);
  listPoints(out);
  paint(scan, labels, out);
}

void PointProjector::locate(const std::vector<ScanPoint>& scan, Projection& out)
{
  const std::size_t pixels = std::size_t{rows_} * columns_;
  out.pixel_of_point.resize(scan.size());
  out.owner_of_pixel.assign(pixels, Projection::kNone);
  out.begin.assign(pixels + 1, 0);
  nearest_.assign(columns_, kInfinity);

  RingCounter rings;
  const float columns_per_radian = static_cast<float>(columns_) / (2.0F * kPi);
  const std::uint32_t last_row = rows_ - 1;
  std::uint32_t ring = 0, row_begin = 0, pixel = columns_ / 2;
  for (std::uint32_t i = 0; i < scan.size(); ++i)
  {
    const auto& p = scan[i];
    const float squared_range = p.x * p.x + p.y * p.y + p.z * p.z;
    if (squared_range > 0.0F && squared_range < kInfinity)  // false for NaN
    {
      const float azimuth = fastAzimuth(p.x, p.y);
      if (const std::uint32_t next = rings.next(azimuth); next != ring)
      {
        ring = next;
        if (ring <= last_row) nearest_.assign(columns_, kInfinity);
        row_begin = std::min(ring, last_row) * columns_;
      }
      // azimuth -pi is the same direction as +pi, which is column 0
      const auto column = static_cast<std::uint32_t>(std::max(0.0F, (kPi - azimuth) * columns_per_radian));
      const std::uint32_t in_row = column < columns_ ? column : 0;
      pixel = row_begin + in_row;
      if (squared_range < nearest_[in_row])
      {
        nearest_[in_row] = squared_range;
        out.owner_of_pixel[pixel] = i;
      }
    }
    out.pixel_of_point[i] = pixel;
    ++out.begin[pixel];
  }
  out.rings = scan.empty() ? 0 : ring + 1;
}

void PointProjector::listPoints(Projection& out)
{
  std::uint32_t end = 0;
  for (auto& entry : out.begin) entry = end += entry;
  out.points.resize(out.pixel_of_point.size());
  // from the last point to the first, each list fills from its end, and `begin` becomes what its name says
  for (auto i = static_cast<std::uint32_t>(out.points.size()); i-- > 0;)
    out.points[--out.begin[out.pixel_of_point[i]]] = i;
}

void PointProjector::paint(const std::vector<ScanPoint>& scan, const std::vector<std::uint32_t>& labels,
                           Projection& out) const
{
  const LabelledPoint empty = noReturn();
  out.cloud.points.resize(out.owner_of_pixel.size());
  out.cloud.width = columns_;
  out.cloud.height = rows_;
  out.cloud.is_dense = false;
  for (std::size_t pixel = 0; pixel < out.owner_of_pixel.size(); ++pixel)
  {
    auto& to = out.cloud.points[pixel];
    to = empty;
    const std::uint32_t owner = out.owner_of_pixel[pixel];
    if (owner == Projection::kNone) continue;
    const auto& from = scan[owner];
    to.x = from.x, to.y = from.y, to.z = from.z;
    to.intensity = from.remission;
    if (!labels.empty()) to.label = labels[owner] & 0xFFFFU;
  }
}
}  // namespace lidar_panoptic_clustering
