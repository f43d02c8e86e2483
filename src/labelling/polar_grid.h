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
/// apart. The cells of a bin lie in a row, so that neighbours along a scan line are neighbours here.
class PolarGrid
{
public:
  static constexpr std::uint32_t kSectors = 180;
  static constexpr std::uint32_t kBins = 20 + 20 + 15 + 15;
  static constexpr std::uint32_t kCells = kSectors * kBins;

  PolarGrid()
  {
    std::uint32_t bin = 0;
    float begin = 0.0F;
    cell_of_step_.back() = kCells;
    for (const Zone& zone : kZones)
      for (; begin < zone.end; begin += zone.width, ++bin)
      {
        middle_[bin] = begin + 0.5F * zone.width;
        const auto first = static_cast<std::size_t>(begin / kFinest);
        const auto last = static_cast<std::size_t>((begin + zone.width) / kFinest);
        for (std::size_t step = first; step < last; ++step)
          cell_of_step_[step] = static_cast<std::uint16_t>(cell(bin, 0));
      }
  }

  /// Its middle [m].
  float middleOf(std::uint32_t bin) const { return middle_[bin]; }

  static std::uint32_t cell(std::uint32_t bin, std::uint32_t sector) { return bin * kSectors + sector; }

  /// The cell of a place [m], `range` [m] away; the last bin holds all beyond it.
  std::uint32_t cellOf(float x, float y, float range) const
  {
    const auto step = static_cast<std::uint32_t>(range / kFinest);
    return cell_of_step_[std::min<std::size_t>(step, kSteps - 1)] + sectorOf(x, y);
  }

  /// The same of four places at once; kCells where `is_place` is 0.
  void cellsOf(const FourFloats& x, const FourFloats& y, const FourFloats& range, const FourInts& is_place,
               std::uint16_t* cells) const
  {
    const FourFloats turn = y / (absolute(x) + absolute(y));
    const FourFloats quarters = select(x >= 0.0F, 1.0F + turn, 3.0F - turn);
    const FourFloats beyond = broadcast(kSteps - 1), last = broadcast(kSectors - 1), none = broadcast(kSteps);
    const FourFloats scaled = range / kFinest, around = quarters * (0.25F * kSectors);
    const FourInts step = truncated(select(is_place, select(scaled < beyond, scaled, beyond), none));
    const FourInts sector = truncated(select(around < last, around, last)) & is_place;
    for (int k = 0; k < 4; ++k)
      cells[k] = static_cast<std::uint16_t>(cell_of_step_[static_cast<std::uint32_t>(step[k])] + sector[k]);
  }

private:
  struct Zone
  {
    float end, width;  // [m]
  };
  static constexpr std::array<Zone, 4> kZones = {{{10.0F, 0.5F}, {30.0F, 1.0F}, {60.0F, 2.0F}, {120.0F, 4.0F}}};
  static constexpr float kFinest = 0.5F;
  static constexpr std::size_t kSteps = 240;

  /// By the angle of the square that turns with x and y instead of the circle's: no trigonometry.
  static std::uint32_t sectorOf(float x, float y)
  {
    const float turn = y / (std::abs(x) + std::abs(y));            // -1..1
    const float quarters = x >= 0.0F ? 1.0F + turn : 3.0F - turn;  // 0..4
    return std::min(kSectors - 1, static_cast<std::uint32_t>(quarters * (0.25F * kSectors)));
  }

  std::array<float, kBins> middle_{};
  std::array<std::uint16_t, kSteps + 1> cell_of_step_{};  ///< the first of the bin; last of all kCells
};
}  // namespace lidar_panoptic_clustering
