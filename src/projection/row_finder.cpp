#include "lidar_panoptic_clustering/projection/row_finder.h"

#include "lidar_panoptic_clustering/projection/azimuth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kFullTurn = 6.28318530717958648;
constexpr std::uint32_t kMinColumns = 16, kMaxColumns = 16384;
}  // namespace

std::uint32_t RowFinder::byRing(const std::vector<ScanPoint>& scan, const std::vector<std::uint32_t>& ring_of_point,
                                std::uint32_t rows)
{
  const std::uint32_t limit = rows > 0 ? rows : kMaxRings;
  std::uint32_t highest = 0;
  for (const std::uint32_t ring : ring_of_point) highest = std::max(highest, ring);
  if (highest >= limit)
    throw std::invalid_argument("expected ring numbers below " + std::to_string(limit) +
                                (rows > 0 ? ", the sensor's beams" : "") + ", found " + std::to_string(highest));
  directions_.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
    directions_[i] = {hasDirection(scan[i]) ? fastAzimuth(scan[i].x, scan[i].y) : kNaN, ring_of_point[i]};
  const std::uint32_t rings = rows > 0 ? rows : highest + 1;
  orderRings(scan, rings);
  return rings;
}

std::uint32_t RowFinder::byBeam(const std::vector<ScanPoint>& scan, const BeamTable& beams)
{
  directions_.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    const ScanPoint& p = scan[i];
    const float squared_range = p.x * p.x + p.y * p.y + p.z * p.z;
    directions_[i] = {kNaN, 0};
    if (hasDirection(p)) directions_[i] = {fastAzimuth(p.x, p.y), beams.nearest(p.z / std::sqrt(squared_range))};
  }
  return beams.rows();
}

std::uint32_t RowFinder::byUnfolding(const std::vector<ScanPoint>& scan, std::uint32_t rows)
{
  const std::uint32_t found = unfoldScan(scan, directions_);
  const std::uint32_t rings = std::min(rows > 0 ? rows : std::max(1U, found), kMaxRings);
  for (PointDirection& direction : directions_) direction.row = std::min(direction.row, rings - 1);
  orderRings(scan, rings);
  return rings;
}

bool RowFinder::canBeUnfolded(const std::vector<ScanPoint>& scan, std::uint32_t rows)
{
  constexpr std::uint32_t kMostRings = 256;
  const std::uint32_t found = unfoldScan(scan, directions_);
  if (found < 2 || found > kMostRings) return false;
  if (rows > 0 && (found > rows || 2 * found < rows)) return false;
  order_.look(scan, directions_, found);
  return order_.isMonotone();
}

void RowFinder::orderRings(const std::vector<ScanPoint>& scan, std::uint32_t rings)
{
  order_.look(scan, directions_, rings);
  const auto& row_of_ring = order_.rowOfRing();
  for (PointDirection& direction : directions_) direction.row = row_of_ring[direction.row];
}

std::uint32_t RowFinder::columnsOfTurn()
{
  returns_of_row_.assign(kMaxRings, 0);
  for (const PointDirection& direction : directions_) returns_of_row_[direction.row] += !std::isnan(direction.azimuth);
  const auto fullest = std::max_element(returns_of_row_.begin(), returns_of_row_.end());
  const auto row = static_cast<std::uint32_t>(fullest - returns_of_row_.begin());

  azimuths_.clear();
  for (const PointDirection& direction : directions_)
    if (direction.row == row && !std::isnan(direction.azimuth)) azimuths_.push_back(direction.azimuth);
  std::sort(azimuths_.begin(), azimuths_.end());
  // gaps take the azimuths' place; smaller ones are returns of one firing
  constexpr float kSmallestGap = static_cast<float>(kFullTurn) / (2.0F * kMaxColumns);
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < azimuths_.size(); ++i)
    if (const float gap = azimuths_[i] - azimuths_[i - 1]; gap > kSmallestGap) azimuths_[gaps++] = gap;
  if (gaps == 0) return kMinColumns;
  const auto middle = azimuths_.begin() + static_cast<std::ptrdiff_t>(gaps / 2);
  std::nth_element(azimuths_.begin(), middle, azimuths_.begin() + static_cast<std::ptrdiff_t>(gaps));
  const double firings = kFullTurn / *middle;
  std::uint32_t columns = kMinColumns;
  while (columns < 0.9 * firings && columns < kMaxColumns) columns *= 2;
  return columns;
}
}  // namespace lidar_panoptic_clustering
