#include "lidar_panoptic_clustering/labelling/polar_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265F;
constexpr std::size_t kElevationBins = 720, kAzimuthBins = 360;  // a quarter of a degree, a degree

/// The bin below which `count` of what the bins hold lie.
std::size_t quantile(const std::array<std::size_t, kElevationBins>& bins, std::size_t count)
{
  std::size_t bin = 0, below = 0;
  while (bin + 1 < bins.size() && below + bins[bin] <= count) below += bins[bin++];
  return bin;
}
}  // namespace

PolarView::Extent PolarView::measure(const std::vector<ScanPoint>& points)
{
  std::array<std::size_t, kElevationBins> elevations{};
  std::array<bool, kAzimuthBins> seen{};
  directions_.resize(points.size());
  elevation_.resize(points.size());
  Extent extent;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const ScanPoint& p = points[i];
    directions_[i] = {std::numeric_limits<float>::quiet_NaN(), 0};
    if (!hasDirection(p)) continue;
    directions_[i].azimuth = std::atan2(p.y, p.x);
    elevation_[i] = std::atan2(p.z, std::sqrt(p.x * p.x + p.y * p.y));
    ++extent.returns;
    const float up = (elevation_[i] / kPi + 0.5F) * kElevationBins;
    ++elevations[std::min(kElevationBins - 1, static_cast<std::size_t>(std::max(0.0F, up)))];
    const float around = (directions_[i].azimuth / kPi + 1.0F) * (0.5F * kAzimuthBins);
    seen[std::min(kAzimuthBins - 1, static_cast<std::size_t>(std::max(0.0F, around)))] = true;
  }
  constexpr float kBin = kPi / kElevationBins;
  const std::size_t outside = extent.returns / 1000;
  extent.lowest = kBin * static_cast<float>(quantile(elevations, outside)) - 0.5F * kPi;
  extent.highest = kBin * static_cast<float>(quantile(elevations, extent.returns - outside) + 1) - 0.5F * kPi;
  extent.turn = 2.0F * kPi / kAzimuthBins * static_cast<float>(std::count(seen.begin(), seen.end(), true));
  return extent;
}

OrganizedScan& PolarView::of(const std::vector<ScanPoint>& points)
{
  constexpr float kFiner = 1.5F;  // along the rows and, inverted, across: their ratio is the square
  constexpr std::uint32_t kMostRows = 256, kFewestColumns = 180, kMostColumns = 4096;
  const Extent extent = measure(points);
  const float height = std::max(extent.highest - extent.lowest, 0.01F);
  const float step = std::sqrt(height * std::max(extent.turn, 0.01F) / static_cast<float>(extent.returns + 1));
  const auto rows = std::clamp(static_cast<std::uint32_t>(height / (step * kFiner)), 1U, kMostRows);
  const auto columns = std::clamp(static_cast<std::uint32_t>(2.0F * kPi * kFiner / step), kFewestColumns, kMostColumns);
  const float per_row = static_cast<float>(rows) / height, last_row = static_cast<float>(rows - 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isnan(directions_[i].azimuth))
      directions_[i].row =
          static_cast<std::uint32_t>(std::clamp((extent.highest - elevation_[i]) * per_row, 0.0F, last_row));
  projector_.project(points, {}, directions_, rows, columns, 0xFFFFFFFFU, view_.image);
  view_.points = points;
  view_.labels.assign(points.size(), 0);
  view_.layout = Layout::kBeams;
  view_.organized_input = false;
  return view_;
}
}  // namespace lidar_panoptic_clustering
