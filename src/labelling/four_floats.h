// Four points at once: arithmetic on vectors as any processor of the last twenty years has them, without flags.
#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

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

/// Four values that lie in a row in memory.
template <class Value>
inline FourFloats loadFour(const Value* from)
{
  static_assert(sizeof(Value) == sizeof(float));
  FourFloats values;
  std::memcpy(&values, from, sizeof(values));
  return values;
}

inline FourInts bitsIn(const FourFloats& values)
{
  FourInts bits;
  std::memcpy(&bits, &values, sizeof(bits));
  return bits;
}

inline FourFloats floatsOf(const FourInts& bits)
{
  FourFloats values;
  std::memcpy(&values, &bits, sizeof(values));
  return values;
}

/// Towards zero; the values are those of whole numbers of 32 bits, or the result is any.
inline FourInts truncated(const FourFloats& values)
{
  return __builtin_convertvector(values, FourInts);
}

inline FourFloats asFloats(const FourInts& values)
{
  return __builtin_convertvector(values, FourFloats);
}

/// By lane `a` where the mask is -1, `b` where it is 0.
inline FourInts select(const FourInts& mask, const FourInts& a, const FourInts& b)
{
  return (a & mask) | (b & ~mask);
}

inline FourFloats select(const FourInts& mask, const FourFloats& a, const FourFloats& b)
{
  return floatsOf(select(mask, bitsIn(a), bitsIn(b)));
}

/// The smaller by lane; `b` where either is NaN.
inline FourFloats smaller(const FourFloats& a, const FourFloats& b)
{
#ifdef __SSE2__
  return _mm_min_ps(a, b);
#else
  return select(a < b, a, b);
#endif
}

inline FourFloats absolute(const FourFloats& values)
{
  return floatsOf(bitsIn(values) & 0x7FFFFFFF);
}

inline FourFloats squareRoot(const FourFloats& values)
{
#ifdef __SSE2__
  return _mm_sqrt_ps(values);
#else
  return FourFloats{std::sqrt(values[0]), std::sqrt(values[1]), std::sqrt(values[2]), std::sqrt(values[3])};
#endif
}

/// A mask's lanes as bits, the first the lowest.
inline std::uint32_t bitsOf(const FourInts& mask)
{
#ifdef __SSE2__
  return static_cast<std::uint32_t>(_mm_movemask_ps(floatsOf(mask)));
#else
  return (mask[0] & 1U) | (mask[1] & 2U) | (mask[2] & 4U) | (mask[3] & 8U);
#endif
}

/// Writes whole numbers from 0 to 32767.
inline void writeShorts(const FourInts& values, std::uint16_t* to)
{
#ifdef __SSE2__
  const auto wide = reinterpret_cast<const __m128i&>(values);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_packs_epi32(wide, wide));
#else
  for (int k = 0; k < 4; ++k) to[k] = static_cast<std::uint16_t>(values[k]);
#endif
}

/// Columns of four rows of four: the first three of x, y, z and whatever comes next.
struct FourColumns
{
  FourColumns(const FourFloats& a, const FourFloats& b, const FourFloats& c, const FourFloats& d)
  {
#ifdef __SSE2__
    const __m128 ab = _mm_unpacklo_ps(a, b), cd = _mm_unpacklo_ps(c, d);
    first = _mm_movelh_ps(ab, cd), second = _mm_movehl_ps(cd, ab);
    third = _mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
#else
    first = FourFloats{a[0], b[0], c[0], d[0]}, second = FourFloats{a[1], b[1], c[1], d[1]};
    third = FourFloats{a[2], b[2], c[2], d[2]};
#endif
  }

  FourFloats first, second, third;
};

/// Coordinates of four points.
struct FourPoints
{
  explicit FourPoints(const LabelledPoint* p) : FourPoints(p[0], p[1], p[2], p[3]) {}
  FourPoints(const LabelledPoint& a, const LabelledPoint& b, const LabelledPoint& c, const LabelledPoint& d)
      : FourPoints(FourColumns(loadFour(a.data), loadFour(b.data), loadFour(c.data), loadFour(d.data)))
  {
  }
  explicit FourPoints(const FourColumns& columns) : x(columns.first), y(columns.second), z(columns.third) {}

  FourFloats x, y, z;
};

/// Writes a0 b0 a1 b1 and a2 b2 a3 b3.
inline void writeInterleaved(const FourFloats& a, const FourFloats& b, float* to)
{
#ifdef __SSE2__
  _mm_storeu_ps(to, _mm_unpacklo_ps(a, b));
  _mm_storeu_ps(to + 4, _mm_unpackhi_ps(a, b));
#else
  for (int k = 0; k < 4; ++k) to[2 * k] = a[k], to[2 * k + 1] = b[k];
#endif
}
}  // namespace lidar_panoptic_clustering
