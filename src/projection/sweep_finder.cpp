#include "lidar_panoptic_clustering/projection/sweep_finder.h"

#include "lidar_panoptic_clustering/projection/azimuth.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kFullTurn = 6.28318530717959F;

float turn(float angle)
{
  if (angle < 0.0F) angle += kFullTurn;
  return angle < kFullTurn ? angle : 0.0F;
}
}  // namespace

float usualStep(std::vector<float>& steps)
{
  if (steps.empty()) return 0.0F;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::optional<Sweep> SweepFinder::find(const std::vector<ScanPoint>& scan)
{
  gather(scan);
  const auto clockwise = goesClockwise();
  if (!clockwise) return std::nullopt;
  countArcs(*clockwise);
  return bestStart(*clockwise);
}

void SweepFinder::gather(const std::vector<ScanPoint>& scan)
{
  returns_.clear();
  for (const ScanPoint& p : scan)
  {
    const float squared_range = p.x * p.x + p.y * p.y + p.z * p.z;
    if (hasDirection(p)) returns_.push_back({fastAzimuth(p.x, p.y), p.z / std::sqrt(squared_range)});
  }
}

std::optional<bool> SweepFinder::goesClockwise() const
{
  constexpr float kSmallStep = 0.2F;  // [rad]
  std::size_t left = 0, right = 0;
  for (std::size_t i = 1; i < returns_.size(); ++i)
  {
    const float step = std::remainder(returns_[i].azimuth - returns_[i - 1].azimuth, kFullTurn);
    left += step > 0.0F && step < kSmallStep;
    right += step < 0.0F && step > -kSmallStep;
  }
  const std::size_t steps = left + right;
  if (2 * steps < returns_.size() || 5 * std::max(left, right) < 4 * steps) return std::nullopt;
  return right > left;
}

float SweepFinder::leastStep()
{
  steps_.clear();
  for (std::size_t i = 1; i < returns_.size(); i += 7)
    steps_.push_back(std::abs(returns_[i].sine - returns_[i - 1].sine));
  return std::max(kElevationStep, 4.0F * usualStep(steps_));
}

void SweepFinder::countArcs(bool clockwise)
{
  arcs_.assign(kBins + 1, 0);
  const float sense = clockwise ? -1.0F : 1.0F;
  const auto bin = [&](const Return& r)
  {
    const auto found = static_cast<std::uint32_t>(turn(sense * r.azimuth) * (static_cast<float>(kBins) / kFullTurn));
    return std::min(found, kBins - 1);
  };
  const float least = leastStep();
  for (std::size_t i = 1; i < returns_.size(); ++i)
  {
    if (std::abs(returns_[i].sine - returns_[i - 1].sine) < least) continue;
    std::uint32_t begin = bin(returns_[i - 1]), end = bin(returns_[i]);
    if (begin > end && begin - end < kOverlap) std::swap(begin, end);  // a ring that ends where the next has begun
    ++arcs_[begin], --arcs_[end + 1];
    if (begin > end) ++arcs_[0], --arcs_[kBins];  // over the wrap
  }
  for (std::uint32_t i = 1; i < kBins; ++i) arcs_[i] += arcs_[i - 1];
}

/// The middle of the longest run of bins that nearly as many arcs hold as any.
Sweep SweepFinder::bestStart(bool clockwise) const
{
  const std::int32_t most = *std::max_element(arcs_.begin(), arcs_.begin() + kBins);
  const auto good = [&](std::uint32_t bin) { return 10 * arcs_[bin % kBins] >= 9 * most; };
  if (!clockwise && good(kBins - 1) && good(0)) return {};  // KITTI's
  std::uint32_t begin = 0, length = 0;
  for (std::uint32_t i = 0, run = 0; i < 2 * kBins && length < kBins; ++i)
  {
    run = good(i) ? run + 1 : 0;
    if (run > length) length = run, begin = i + 1 - run;
  }
  const float middle =
      turn((static_cast<float>(begin) + 0.5F * static_cast<float>(length)) * (kFullTurn / static_cast<float>(kBins)) -
           (begin + length / 2 >= kBins ? kFullTurn : 0.0F));
  const float azimuth = clockwise ? -middle : middle;
  return {clockwise, std::remainder(azimuth, kFullTurn)};
}
}  // namespace lidar_panoptic_clustering
