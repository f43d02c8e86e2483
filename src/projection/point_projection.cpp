#include "lidar_panoptic_clustering/projection/point_projection.h"

#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/azimuth.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265358979F;

LabelledPoint noReturn()
{
  LabelledPoint point;
  point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
  return point;
}

float squaredRange(const ScanPoint& p)
{
  return p.x * p.x + p.y * p.y + p.z * p.z;
}

void paint(ScanPoints scan, const std::vector<std::uint32_t>& labels, std::uint32_t class_bits, Projection& out)
{
  const LabelledPoint empty = noReturn();
  for (std::size_t pixel = 0; pixel < out.owner_of_pixel.size(); ++pixel)
  {
    auto& to = out.cloud.points[pixel];
    to = empty;
    const std::uint32_t owner = out.owner_of_pixel[pixel];
    if (owner == Projection::kNone) continue;
    const auto& from = scan[owner];
    to.x = from.x, to.y = from.y, to.z = from.z;
    to.intensity = from.remission;
    if (!labels.empty()) to.label = labels[owner] & class_bits;
  }
}
}  // namespace

void DirectionProjector::project(ScanPoints scan, const std::vector<std::uint32_t>& labels,
                                 const std::vector<PointDirection>& directions, std::uint32_t rows,
                                 std::uint32_t columns, std::uint32_t class_bits, Projection& out, float shift)
{
  const std::size_t pixels = std::size_t{rows} * columns;
  out.pixel_of_point.resize(scan.size());
  out.owner_of_pixel.assign(pixels, Projection::kNone);
  out.begin.assign(pixels + 1, 0);
  out.points.resize(scan.size());
  out.cloud.points.resize(pixels);
  out.cloud.width = columns;
  out.cloud.height = rows;
  out.cloud.is_dense = false;
  locate(scan, directions, columns, shift, out);
  listPoints(out);
  paint(scan, labels, class_bits, out);
}

void DirectionProjector::locate(ScanPoints scan, const std::vector<PointDirection>& directions, std::uint32_t columns,
                                float shift, Projection& out)
{
  hidden_.clear();
  returns_ = 0;
  const float columns_per_radian = static_cast<float>(columns) / (2.0F * kPi);
  std::uint32_t pixel = columns / 2;
  for (std::uint32_t i = 0; i < scan.size(); ++i)
  {
    const auto [azimuth, row] = directions[i];
    std::uint32_t hidden = i;
    if (azimuth == azimuth)  // false for NaN
    {
      // azimuth -pi is the same direction as +pi, which is column 0
      const auto column = static_cast<std::uint32_t>(std::max(0.0F, (kPi - azimuth) * columns_per_radian + shift));
      pixel = row * columns + (column < columns ? column : 0);
      ++returns_;
      std::uint32_t& owner = out.owner_of_pixel[pixel];
      if (owner == Projection::kNone || squaredRange(scan[i]) < squaredRange(scan[owner])) std::swap(owner, hidden);
    }
    out.pixel_of_point[i] = pixel;
    if (hidden != Projection::kNone) hidden_.push_back(hidden);
  }
  without_return_ = scan.size() - returns_;
}

void DirectionProjector::listPoints(Projection& out) const
{
  // only pixels that hide points are visited out of order
  for (const std::uint32_t point : hidden_) ++out.begin[out.pixel_of_point[point]];
  std::uint32_t end = 0;
  for (std::size_t pixel = 0; pixel < out.owner_of_pixel.size(); ++pixel)
  {
    end += out.begin[pixel] + (out.owner_of_pixel[pixel] != Projection::kNone);
    out.begin[pixel] = end;
  }
  out.begin.back() = end;
  // from the last point to the first, each list fills from its end, and `begin` becomes what its name says
  for (auto point = hidden_.rbegin(); point != hidden_.rend(); ++point)
    out.points[--out.begin[out.pixel_of_point[*point]]] = *point;
  for (std::size_t pixel = out.owner_of_pixel.size(); pixel-- > 0;)
  {
    if (out.owner_of_pixel[pixel] == Projection::kNone) continue;
    const std::uint32_t first = --out.begin[pixel], last = out.begin[pixel + 1];
    out.points[first] = out.owner_of_pixel[pixel];
    // an owner that lost its pixel stands behind those that came after it: each of them is passed by one owner at most
    for (std::uint32_t k = first + 1; k < last; ++k)
      for (std::uint32_t j = k; j > first && out.points[j] < out.points[j - 1]; --j)
        std::swap(out.points[j], out.points[j - 1]);
  }
}

PointProjector::PointProjector(const ProjectionConfig& config)
    : rows_(static_cast<std::uint32_t>(config.rows)), columns_(static_cast<std::uint32_t>(config.columns))
{
  validateParameters(config);
}

void PointProjector::project(ScanPoints scan, const std::vector<std::uint32_t>& labels, Projection& out)
{
  if (!labels.empty() && labels.size() != scan.size())
    throw std::invalid_argument("expected one label a point, found " + std::to_string(labels.size()) + " labels for " +
                                std::to_string(scan.size()) + " points");
  out.rings = unfoldScan(scan, Sweep(), directions_);
  for (PointDirection& direction : directions_) direction.row = std::min(direction.row, rows_ - 1);
  projector_.project(scan, labels, directions_, rows_, columns_, 0xFFFFU, out);
}

std::uint32_t unfoldScan(ScanPoints scan, const Sweep& sweep, std::vector<PointDirection>& directions)
{
  RingCounter rings(sweep);
  std::uint32_t ring = 0;
  directions.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    float azimuth = std::numeric_limits<float>::quiet_NaN();
    if (hasDirection(scan[i]))
    {
      azimuth = fastAzimuth(scan[i].x, scan[i].y);
      ring = rings.next(azimuth);
    }
    directions[i] = {azimuth, ring};
  }
  return scan.empty() ? 0 : ring + 1;
}
}  // namespace lidar_panoptic_clustering
