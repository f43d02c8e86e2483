#pragma once

#include <cstdint>

namespace lidar_panoptic_clustering
{
// Places along the Z-curve over 8 x 8 cells, on which every block of 2 x 2 and of 4 x 4 cells is a stretch.

inline constexpr std::uint32_t kSpread[8] = {0, 1, 4, 5, 16, 17, 20, 21};  // the bits of a number, every second one

constexpr std::uint8_t bitsOf(unsigned byte)
{
  return static_cast<std::uint8_t>(byte == 0 ? 0 : (byte & 1U) + bitsOf(byte >> 1U));
}
struct BitCounts
{
  std::uint8_t of[256];
};
constexpr BitCounts makeBitCounts()
{
  BitCounts counts{};
  for (unsigned byte = 0; byte < 256; ++byte) counts.of[byte] = bitsOf(byte);
  return counts;
}
inline constexpr BitCounts kBitCounts = makeBitCounts();

/// Place along the Z-curve of column x and row y < 8.
inline std::uint32_t alongCurve(std::uint32_t x, std::uint32_t y)
{
  return kSpread[x] | kSpread[y] << 1U;
}

struct CurvePlace
{
  std::uint8_t x, y;
};
struct Curve
{
  CurvePlace of[64];
};
constexpr Curve makeCurve()
{
  Curve curve{};
  for (std::uint8_t y = 0; y < 8; ++y)
    for (std::uint8_t x = 0; x < 8; ++x) curve.of[kSpread[x] | kSpread[y] << 1U] = {x, y};
  return curve;
}
inline constexpr Curve kCurve = makeCurve();  // the column and row of each place along it
}  // namespace lidar_panoptic_clustering
