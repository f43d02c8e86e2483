#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Sorts by whole numbers, a digit after the other (radix sort from the least digit on): linear in the values and in
/// the digits. What is equal keeps its order. Keeps its memory.
template <class Value>
class StepSort
{
public:
  /// `keyOf(value)` is a whole number below 2^bits.
  template <class KeyOf>
  void sort(std::vector<Value>& values, int bits, const KeyOf& keyOf)
  {
    const int widest = std::clamp(bitsOf(values.size()), 6, 11);
    const int steps = (bits + widest - 1) / widest, digit = (bits + steps - 1) / steps;
    const std::uint64_t mask = (std::uint64_t{1} << digit) - 1;
    aside_.resize(values.size());
    for (int step = 0, shift = 0; step < steps; ++step, shift += digit)
    {
      counts_.assign(mask + 1, 0);
      for (const Value& value : values) ++counts_[static_cast<std::uint64_t>(keyOf(value)) >> shift & mask];
      std::uint32_t begin = 0;
      for (std::uint32_t& count : counts_) begin += std::exchange(count, begin);
      for (const Value& value : values)
        aside_[counts_[static_cast<std::uint64_t>(keyOf(value)) >> shift & mask]++] = value;
      values.swap(aside_);
    }
  }

private:
  static int bitsOf(std::size_t count)
  {
    int bits = 1;
    while (count >> bits != 0) ++bits;
    return bits;
  }

  std::vector<Value> aside_;
  std::vector<std::uint32_t> counts_;  ///< by digit
};

/// Sorts by a float, and where that is the same, by comparison: many values in linear time, but for those of the same
/// float. Keeps its memory.
template <class Value>
class FloatSort
{
public:
  /// `floatOf(value)` is a number; `isBefore(a, b)` is asked of values with the same one.
  template <class FloatOf, class IsBefore>
  void sort(std::vector<Value>& values, const FloatOf& floatOf, const IsBefore& isBefore)
  {
    constexpr std::size_t kFew = 512;  // below, comparison is as quick
    if (values.size() < kFew)
    {
      std::sort(values.begin(), values.end(),
                [&](const Value& a, const Value& b)
                { return floatOf(a) < floatOf(b) || (floatOf(a) == floatOf(b) && isBefore(a, b)); });
      return;
    }
    steps_.sort(values, 32, [&floatOf](const Value& value) { return orderOf(floatOf(value)); });
    for (auto begin = values.begin(), end = begin; begin != values.end(); begin = end)
    {
      const float same = floatOf(*begin);
      while (end != values.end() && floatOf(*end) == same) ++end;
      if (end - begin > 1 && !std::is_sorted(begin, end, isBefore)) std::sort(begin, end, isBefore);
    }
  }

private:
  /// A whole number that orders as the float does.
  static std::uint32_t orderOf(float value)
  {
    constexpr std::uint32_t kSign = 0x80000000;
    value += 0.0F;  // there are two zeros
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    return (bits & kSign) != 0 ? ~bits : bits | kSign;
  }

  StepSort<Value> steps_;
};
}  // namespace lidar_panoptic_clustering
