// Four points at once: arithmetic on vectors as any processor of the last twenty years has them, without flags.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace lidar_panoptic_clustering
{
using FourFloats = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

inline FourFloats broadcast(float value)
{
  return FourFloats{value, value, value, value};
}

/// Towards zero; the values are those of whole numbers of 32 bits, or the result is any.
inline FourInts truncated(const FourFloats& values)
{
  return __builtin_convertvector(values, FourInts);
}

/// By lane `a` where the mask is -1, `b` where it is 0.
inline FourFloats select(const FourInts& mask, const FourFloats& a, const FourFloats& b)
{
  FourInts a_bits, b_bits;
  std::memcpy(&a_bits, &a, sizeof(a_bits));
  std::memcpy(&b_bits, &b, sizeof(b_bits));
  const FourInts bits = (a_bits & mask) | (b_bits & ~mask);
  FourFloats selected;
  std::memcpy(&selected, &bits, sizeof(selected));
  return selected;
}

inline FourFloats absolute(const FourFloats& values)
{
  FourInts bits;
  std::memcpy(&bits, &values, sizeof(bits));
  bits &= 0x7FFFFFFF;
  FourFloats positive;
  std::memcpy(&positive, &bits, sizeof(positive));
  return positive;
}

inline FourFloats squareRoot(const FourFloats& values)
{
#ifdef __SSE2__
  return _mm_sqrt_ps(values);
#else
  return FourFloats{std::sqrt(values[0]), std::sqrt(values[1]), std::sqrt(values[2]), std::sqrt(values[3])};
#endif
}
}  // namespace lidar_panoptic_clustering
