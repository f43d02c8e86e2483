#include "lidar_panoptic_clustering/projection/point_projection.h"

#include "lidar_panoptic_clustering/core/parameters.h"
#include "projection/point_azimuths.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265358979F;

float squaredRange(const ScanPoint& p)
{
  return p.x * p.x + p.y * p.y + p.z * p.z;
}

/// Neighbours in a row may lie anywhere in the scan: they are fetched well before they are read.
void paint(ScanPoints scan, const std::vector<std::uint32_t>& labels, std::uint32_t class_bits, Projection& out)
{
  constexpr std::size_t kAhead = 32;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr ScanPoint kNoReturn = {kNaN, kNaN, kNaN, 0.0F};
  const std::size_t pixels = out.owner_of_pixel.size();
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
  {
    const std::uint32_t next = out.owner_of_pixel[std::min(pixel + kAhead, pixels - 1)];
    if (next < scan.size()) __builtin_prefetch(&scan[next]);
    if (next < labels.size()) __builtin_prefetch(&labels[next]);
    const std::uint32_t owner = out.owner_of_pixel[pixel];
    const ScanPoint& from = owner < scan.size() ? scan[owner] : kNoReturn;
    LabelledPoint to;
    to.x = from.x, to.y = from.y, to.z = from.z;
    to.intensity = from.remission;
    to.label = owner < labels.size() ? labels[owner] & class_bits : 0;
    out.cloud.points[pixel] = to;
  }
}
}  // namespace

void DirectionProjector::project(ScanPoints scan, const std::vector<std::uint32_t>& labels,
                                 const std::vector<PointDirection>& directions, std::uint32_t rows,
                                 std::uint32_t columns, std::uint32_t class_bits, Projection& out, float shift)
{
  const std::size_t pixels = std::size_t{rows} * columns;
  out.pixel_of_point.resize(scan.size());
  out.owner_of_pixel.resize(pixels);
  owners_.assign(rows * (std::size_t{columns} + kGap), Projection::kNone);
  out.begin.assign(pixels + 1, 0);
  out.points.resize(scan.size());
  out.cloud.points.resize(pixels);
  out.cloud.width = columns;
  out.cloud.height = rows;
  out.cloud.is_dense = false;
  locate(scan, directions, columns, shift, out);
  takeOwners(rows, columns, out);
  listPoints(out);
  paint(scan, labels, class_bits, out);
}

inline void DirectionProjector::takePixel(ScanPoints scan, std::uint32_t point, PointDirection direction,
                                          Projection& out)
{
  std::uint32_t hidden = point;
  if (direction.azimuth == direction.azimuth)  // false for NaN
  {
    ++returns_;
    std::uint32_t& owner = owners_[out.pixel_of_point[point] + std::size_t{direction.row} * kGap];
    if (owner == Projection::kNone || squaredRange(scan[point]) < squaredRange(scan[owner])) std::swap(owner, hidden);
  }
  if (hidden != Projection::kNone) hidden_.push_back(hidden);
}

void DirectionProjector::locate(ScanPoints scan, const std::vector<PointDirection>& directions, std::uint32_t columns,
                                float shift, Projection& out)
{
  constexpr std::size_t kRun = 64;  // the pixels of a run are fetched before the first of them is looked at
  hidden_.clear();
  returns_ = 0;
  for (std::size_t begin = 0; begin < scan.size(); begin += kRun)
  {
    const std::size_t end = std::min(scan.size(), begin + kRun);
    findPixels(directions, begin, end, columns, shift, out);
    for (std::size_t i = begin; i < end; ++i) takePixel(scan, static_cast<std::uint32_t>(i), directions[i], out);
  }
  without_return_ = scan.size() - returns_;
}

void DirectionProjector::findPixels(const std::vector<PointDirection>& directions, std::size_t begin, std::size_t end,
                                    std::uint32_t columns, float shift, Projection& out)
{
  const float columns_per_radian = static_cast<float>(columns) / (2.0F * kPi);
  std::uint32_t pixel = begin > 0 ? out.pixel_of_point[begin - 1] : columns / 2;
  for (std::size_t i = begin; i < end; ++i)
  {
    const auto [azimuth, row] = directions[i];
    if (azimuth == azimuth)  // false for NaN
    {
      // azimuth -pi is the same direction as +pi, which is column 0
      const auto column = static_cast<std::uint32_t>(std::max(0.0F, (kPi - azimuth) * columns_per_radian + shift));
      pixel = row * columns + (column < columns ? column : 0);
      __builtin_prefetch(&owners_[pixel + std::size_t{row} * kGap], 1);
    }
    out.pixel_of_point[i] = pixel;
  }
}

void DirectionProjector::takeOwners(std::uint32_t rows, std::uint32_t columns, Projection& out)
{
  const std::uint32_t* from = owners_.data();
  std::uint32_t* to = out.owner_of_pixel.data();
  for (std::uint32_t row = 0; row < rows; ++row, from += columns + kGap, to += columns)
    std::copy(from, from + columns, to);
}

void DirectionProjector::listPoints(Projection& out)
{
  // only pixels that hide points are visited out of order
  full_.clear();
  for (const std::uint32_t point : hidden_)
    if (out.begin[out.pixel_of_point[point]]++ == 0) full_.push_back(out.pixel_of_point[point]);
  std::uint32_t end = 0;
  for (std::size_t pixel = 0; pixel < out.owner_of_pixel.size(); ++pixel)
  {
    const std::uint32_t owner = out.owner_of_pixel[pixel], hidden = out.begin[pixel];
    if (owner != Projection::kNone) out.points[end++] = owner;
    end += hidden;
    out.begin[pixel] = hidden == 0 ? end - (owner != Projection::kNone) : end;
  }
  out.begin.back() = end;
  // from the last point to the first, each list fills from its end, and `begin` becomes what its name says
  for (auto point = hidden_.rbegin(); point != hidden_.rend(); ++point)
    out.points[--out.begin[out.pixel_of_point[*point]]] = *point;
  for (const std::uint32_t pixel : full_) out.begin[pixel] -= out.owner_of_pixel[pixel] != Projection::kNone;
  for (const std::uint32_t pixel : full_)
  {
    // an owner that lost its pixel stands behind those that came after it: each of them is passed by one owner at most
    const std::uint32_t first = out.begin[pixel], last = out.begin[pixel + 1];
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
  forEachAzimuth(scan,
                 [&](std::size_t i, float azimuth, float)
                 {
                   if (azimuth == azimuth) ring = rings.next(azimuth);
                   directions[i] = {azimuth, ring};
                 });
  return scan.empty() ? 0 : ring + 1;
}
}  // namespace lidar_panoptic_clustering
