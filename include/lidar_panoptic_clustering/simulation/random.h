#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>

namespace lidar_panoptic_clustering::simulation
{
/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014, "Fast Splittable Pseudorandom Number Generators").
constexpr std::uint64_t mix(std::uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// A well mixed value of two; not symmetric.
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b)
{
  return mix(mix(a + 0x9E3779B97F4A7C15ULL) + b);
}

/// Number `n` of the endless series that belongs to `key`; keys are themselves well mixed.
constexpr std::uint64_t draw(std::uint64_t key, std::uint64_t n)
{
  return mix(key + (n + 1) * 0x9E3779B97F4A7C15ULL);
}

/// The 16 bits number `part` (0..3) of `bits` as a value in [0, 1).
constexpr float fraction(std::uint64_t bits, int part)
{
  return static_cast<float>((bits >> (16 * part)) & 0xFFFFU) * 0x1p-16F;
}

/// About normally distributed with mean 0 and deviation 1, within +-3.47: the sum of the four fractions of `bits`
/// (Irwin-Hall). No library function takes part, so that every platform gives the same scan.
constexpr float gaussian(std::uint64_t bits)
{
  return (fraction(bits, 0) + fraction(bits, 1) + fraction(bits, 2) + fraction(bits, 3) - 2.0F) * 1.7320508F;
}

/// A stream of random numbers, the same for the same key with every compiler and standard library (the distributions
/// of <random> are not). Draw each number in a statement of its own: the order of arguments is not specified.
class Random
{
public:
  explicit Random(std::uint64_t key) : state_(key) {}

  std::uint64_t next() { return mix(state_ += 0x9E3779B97F4A7C15ULL); }
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53; }
  float uniform(float low, float high) { return static_cast<float>(uniform(double{low}, double{high})); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  /// 0..n-1; n > 0.
  int below(int n) { return static_cast<int>((next() >> 33) % static_cast<std::uint64_t>(n)); }

private:
  std::uint64_t state_;
};
}  // namespace lidar_panoptic_clustering::simulation
