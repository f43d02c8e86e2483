#include "lidar_panoptic_clustering/projection/row_finder.h"

#include "projection/point_azimuths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kFullTurn = 6.28318530717958648;
constexpr std::uint32_t kMinColumns = 16, kMaxColumns = 16384;

float sineOfElevation(const ScanPoint& p)
{
  return p.z / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

/// A small angle given by its sine.
std::string degrees(double sine)
{
  return std::to_string(std::lround(1800.0 / kFullTurn * 2.0 * sine) / 10) + '.' +
         std::to_string(std::lround(1800.0 / kFullTurn * 2.0 * sine) % 10) + " degrees";
}
}  // namespace

std::uint32_t RowFinder::beamsOf(std::uint32_t highest)
{
  for (const std::uint32_t beams : {16U, 32U, 40U, 64U, 80U, 128U})
    if (highest < beams) return beams;
  return highest + 1;
}

std::uint32_t RowFinder::byRing(const std::vector<ScanPoint>& scan, const std::vector<std::uint32_t>& ring_of_point,
                                std::uint32_t rows, std::uint32_t least)
{
  const std::uint32_t limit = rows > 0 ? rows : kMaxRings;
  std::uint32_t highest = 0;
  for (const std::uint32_t ring : ring_of_point) highest = std::max(highest, ring);
  if (highest >= limit)
    throw std::invalid_argument("expected ring numbers below " + std::to_string(limit) +
                                (rows > 0 ? ", the sensor's beams" : "") + ", found " + std::to_string(highest));
  directions_.resize(scan.size());
  forEachAzimuth(scan, [&](std::size_t i, float azimuth, float) { directions_[i] = {azimuth, ring_of_point[i]}; });
  const std::uint32_t rings = rows > 0 ? rows : std::max(least, beamsOf(highest));
  orderRings(scan, rings, true);
  if (order_.tellsNothing())
    throw std::invalid_argument("expected points of one ring to have one elevation, found that it varies by " +
                                degrees(order_.scatterRad()) + " within a ring, as much as in the whole cloud");
  return rings;
}

std::uint32_t RowFinder::byBeam(const std::vector<ScanPoint>& scan, const BeamTable& beams)
{
  // a quarter where points lie anywhere, a tenth where each beam is a fifth of a degree off at 2 degrees' spacing
  constexpr double kMostMisfit = 0.17;
  constexpr std::size_t kFewest = 100;
  directions_.resize(scan.size());
  double misfit = 0.0;
  std::size_t looked_at = 0;
  forEachAzimuth(scan,
                 [&](std::size_t i, float azimuth, float squared_range)
                 {
                   directions_[i] = {azimuth, 0};
                   if (std::isnan(azimuth)) return;
                   const float sine = scan[i].z / std::sqrt(squared_range);
                   directions_[i].row = beams.nearest(sine);
                   if (i % 13 == 0) misfit += beams.misfit(sine, directions_[i].row), ++looked_at;
                 });
  if (looked_at >= kFewest && misfit > kMostMisfit * static_cast<double>(looked_at))
    throw std::invalid_argument(
        "expected points at the elevations of the sensor's beams, found them " +
        std::to_string(std::lround(100.0 * misfit / static_cast<double>(looked_at))) +
        " % of the beams' spacing away in the mean: another sensor, or a frame that is not the sensor's own");
  return beams.rows();
}

std::uint32_t RowFinder::byUnfolding(const std::vector<ScanPoint>& scan, std::uint32_t rows, std::uint32_t least,
                                     std::optional<Sweep>& sweep)
{
  const auto tryWith = [&](const Sweep& with)
  {
    unfold(scan, with);
    const std::uint32_t found = std::max({1U, least, unfolded_rings_});
    const std::uint32_t rings = std::min(rows > 0 ? rows : found, kMaxRings);
    if (unfolded_rings_ > rings)
      for (PointDirection& direction : directions_) direction.row = std::min(direction.row, rings - 1);
    orderRings(scan, rings, false);
    return rings;
  };
  if (sweep)
    if (const std::uint32_t rings = tryWith(*sweep); cameRingAfterRing(rows)) return rings;
  sweep = sweeps_.find(scan);
  return tryWith(sweep.value_or(Sweep()));
}

void RowFinder::unfold(const std::vector<ScanPoint>& scan, const Sweep& sweep)
{
  unfolded_rings_ = unfoldScan(scan, sweep, directions_);
  constexpr std::size_t kStride = 17;  // no firing has a multiple of it
  constexpr float kSmallStep = 0.2F;   // [rad]
  const float sense = sweep.clockwise ? -1.0F : 1.0F;
  forward_ = backward_ = climbs_ = 0;
  steps_.clear();
  for (std::size_t i = kStride; i < directions_.size(); i += kStride)
  {
    const float step = sense * (directions_[i].azimuth - directions_[i - 1].azimuth);  // NaN goes no way
    forward_ += step > 0.0F && step < kSmallStep;
    backward_ += step < 0.0F && step > -kSmallStep;
    if (std::isnan(step)) continue;
    steps_.push_back(std::abs(sineOfElevation(scan[i]) - sineOfElevation(scan[i - 1])));
    climbs_ += steps_.back() > std::abs(step);
  }
  countElevationSteps(scan);
}

/// Rings that begin with a step of the elevation.
void RowFinder::countElevationSteps(const std::vector<ScanPoint>& scan)
{
  // in a tilted frame the largest steps within a ring are 1.6 times the usual one
  const float least = std::max(kElevationStep, 3.0F * usualStep(steps_));
  elevation_steps_ = 0;
  const ScanPoint* last = nullptr;
  std::uint32_t ring = 0;
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    if (std::isnan(directions_[i].azimuth)) continue;
    if (directions_[i].row != ring && last != nullptr)
      elevation_steps_ += std::abs(sineOfElevation(scan[i]) - sineOfElevation(*last)) > least;
    last = &scan[i];
    ring = directions_[i].row;
  }
}

bool RowFinder::cameRingAfterRing(std::uint32_t rows) const
{
  constexpr std::uint32_t kMostRings = 256;
  const std::uint32_t rings = unfolded_rings_;
  if (rings < 2 || rings > kMostRings) return false;
  if (rows > 0 && (rings > rows || 2 * rings < rows)) return false;
  if (20 * elevation_steps_ < 19 * (rings - 1) || forward_ < 3 * backward_) return false;
  if (2 * climbs_ > steps_.size()) return false;  // firing after firing
  return order_.areOrdered();
}

void RowFinder::orderRings(const std::vector<ScanPoint>& scan, std::uint32_t rings, bool remember)
{
  order_.look(scan, directions_, rings, remember);
  const auto& row_of_ring = order_.rowOfRing();
  if (std::is_sorted(row_of_ring.begin(), row_of_ring.end())) return;
  for (PointDirection& direction : directions_) direction.row = row_of_ring[direction.row];
}

std::uint32_t RowFinder::fullestRow()
{
  returns_of_row_.assign(kMaxRings, 0);
  const std::size_t step = directions_.size() < 64 * std::size_t{kMaxRings} ? 1 : 13;  // as in RingOrder
  for (std::size_t i = 0; i < directions_.size(); i += step)
    returns_of_row_[directions_[i].row] += !std::isnan(directions_[i].azimuth);
  const auto fullest = std::max_element(returns_of_row_.begin(), returns_of_row_.end());
  return static_cast<std::uint32_t>(fullest - returns_of_row_.begin());
}

double RowFinder::firingsOfTurn()
{
  const std::uint32_t row = fullestRow();
  azimuths_.clear();
  for (const PointDirection& direction : directions_)
    if (direction.row == row && !std::isnan(direction.azimuth)) azimuths_.push_back(direction.azimuth);
  std::sort(azimuths_.begin(), azimuths_.end());
  // gaps take the azimuths' place; smaller ones are returns of one firing
  constexpr float kSmallestGap = static_cast<float>(kFullTurn) / (2.0F * kMaxColumns);
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < azimuths_.size(); ++i)
    if (const float gap = azimuths_[i] - azimuths_[i - 1]; gap > kSmallestGap) azimuths_[gaps++] = gap;
  if (gaps == 0) return 0.0;
  const auto middle = azimuths_.begin() + static_cast<std::ptrdiff_t>(gaps / 2);
  std::nth_element(azimuths_.begin(), middle, azimuths_.begin() + static_cast<std::ptrdiff_t>(gaps));
  return kFullTurn / *middle;
}

std::uint32_t RowFinder::columnsFor(double firings)
{
  std::uint32_t columns = kMinColumns;
  while (columns < 0.9 * firings && columns < kMaxColumns) columns *= 2;
  return columns;
}

float RowFinder::columnShift(std::uint32_t columns) const
{
  constexpr std::size_t kPoints = 1024;
  const std::size_t step = (directions_.size() / kPoints) | 1U;
  const float columns_per_radian = static_cast<float>(columns / kFullTurn);
  float from_middle = 0.0F;
  std::size_t count = 0;
  for (std::size_t i = 0; i < directions_.size(); i += step)
  {
    const float azimuth = directions_[i].azimuth;
    if (std::isnan(azimuth)) continue;
    const float column = (0.5F * static_cast<float>(kFullTurn) - azimuth) * columns_per_radian;
    from_middle += std::abs(column - std::floor(column) - 0.5F);
    ++count;
  }
  // a quarter where the azimuths lie anywhere, a half where they lie on borders
  return from_middle > 0.35F * static_cast<float>(count) ? 0.5F : 0.0F;
}
}  // namespace lidar_panoptic_clustering
