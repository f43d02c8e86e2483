#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"

#include "core/plain_numbers.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A number of 64 bits that is another one, almost surely, when what was added differs: against mix-ups, not against
/// malice. FNV-1a on words of 8 bytes, turned so that all bits take part.
class Fingerprint
{
public:
  void add(const void* bytes, std::size_t count)
  {
    const char* from = static_cast<const char*>(bytes);
    for (std::size_t left = count; left > 0;)
    {
      std::uint64_t word = 0;
      const std::size_t taken = left < sizeof word ? left : sizeof word;
      std::memcpy(&word, from, taken);
      mix(word);
      from += taken, left -= taken;
    }
    mix(count);
  }
  void add(const std::string& text) { add(text.data(), text.size()); }

  template <class T>
  void add(const std::vector<T>& values)
  {
    add(values.data(), values.size() * sizeof(T));
  }

  /// 16 hexadecimal digits.
  std::string text() const
  {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value_));
    return digits;
  }

private:
  void mix(std::uint64_t word)
  {
    value_ = (value_ ^ word) * 0x100000001B3ULL;
    value_ = value_ << 29U | value_ >> 35U;
  }

  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

/// Of all in a class table that predictions depend on: names, kinds, ids, groups, sizes and link distances. Colours and
/// aliases, comments and the order of keys in its file do not count.
inline std::string fingerprintOf(const ClassTable& table)
{
  Fingerprint fingerprint;
  for (std::size_t i = 1; i < table.size(); ++i)
  {
    const ClassInfo& info = table[static_cast<ClassIndex>(i)];
    fingerprint.add(info.name);
    fingerprint.add(std::to_string(static_cast<int>(info.kind)) + " " + std::to_string(info.group));
    fingerprint.add(info.ids);
    for (const float metres : {info.length_m, info.width_m, info.link_distance_m})
      fingerprint.add(shortText(metres, 9));
  }
  return fingerprint.text();
}
}  // namespace lidar_panoptic_clustering
