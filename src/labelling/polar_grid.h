// The cells that the ground is followed over: sectors of azimuth by bins of range.
#pragma once

#include "four_floats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lidar_panoptic_clustering
{
/// Sectors of two degrees (half a metre at 15 m) by bins that grow with the range, as the rings on the ground move
/// apart: of half a metre up to 10 m, of 1 m up to 30, 2 up to 60, 4 up to 120. The cells of a bin lie in a row, so
/// that neighbours along a scan line are neighbours here.
class PolarGrid
{
public:
  static constexpr std::uint32_t kSectors = 180;
  static constexpr std::uint32_t kBins = 20 + 20 + 15 + 15;
  static constexpr std::uint32_t kCells = kSectors * kBins;

  PolarGrid()
  {
    std::uint32_t bin = 0;
    for (std::uint32_t step = 0, begin = 0; bin < kBins; ++step)
      if (binOf(static_cast<float>(step + 1)) != bin)
        middle_[bin++] = 0.5F * kFinest * static_cast<float>(begin + step + 1), begin = step + 1;
  }

  /// Its middle [m].
  float middleOf(std::uint32_t bin) const { return middle_[bin]; }

  static std::uint32_t cell(std::uint32_t bin, std::uint32_t sector) { return bin * kSectors + sector; }

  /// The cell of a place [m], `range` [m] away; the last bin holds all beyond it.
  static std::uint32_t cellOf(float x, float y, float range)
  {
    const std::uint32_t bin = std::min(kBins - 1, binOf(std::floor(std::min(range, kEnd) / kFinest)));
    return cell(bin, sectorOf(x, y));
  }

  /// The same of four places at once; kCells where `is_place` is 0.
  static FourInts cellsOf(const FourFloats& x, const FourFloats& y, const FourFloats& range, const FourInts& is_place)
  {
    const FourFloats turn = y / (absolute(x) + absolute(y));
    const FourFloats quarters = select(x >= 0.0F, 1.0F + turn, 3.0F - turn);
    const FourFloats around = smaller(quarters * (0.25F * kSectors), broadcast(kSectors - 1));
    const FourFloats steps = asFloats(truncated(smaller(range, broadcast(kEnd)) / kFinest));
    const FourFloats near = smaller(steps, 10.0F + 0.5F * steps);
    const FourFloats far = smaller(25.0F + 0.25F * steps, smaller(40.0F + 0.125F * steps, broadcast(kBins - 1)));
    const FourInts bin = truncated(smaller(near, far));
    const FourFloats cells = asFloats(bin) * float{kSectors} + asFloats(truncated(around));  // exact below 2^24
    return select(is_place, truncated(cells), FourInts{} + static_cast<std::int32_t>(kCells));
  }

private:
  static constexpr float kFinest = 0.5F;  // [m]
  static constexpr float kEnd = 1000.0F;  // [m] beyond the last bin, and far from what 32 bits do not hold

  /// Of a place so many whole steps of kFinest away; the lines of the zones meet where these do.
  static std::uint32_t binOf(float steps)
  {
    const float near = std::min(steps, 10.0F + 0.5F * steps),
                far = std::min(25.0F + 0.25F * steps, 40.0F + 0.125F * steps);
    return static_cast<std::uint32_t>(std::min(near, far));
  }

  /// By the angle of the square that turns with x and y instead of the circle's: no trigonometry.
  static std::uint32_t sectorOf(float x, float y)
  {
    const float turn = y / (std::abs(x) + std::abs(y));            // -1..1
    const float quarters = x >= 0.0F ? 1.0F + turn : 3.0F - turn;  // 0..4
    return std::min(kSectors - 1, static_cast<std::uint32_t>(quarters * (0.25F * kSectors)));
  }

  std::array<float, kBins> middle_{};
};
}  // namespace lidar_panoptic_clustering
