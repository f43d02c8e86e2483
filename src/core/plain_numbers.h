#pragma once

#include <locale.h>

#include <optional>
#include <string>

namespace lidar_panoptic_clustering
{
/// While it lives, printf, scanf and std::to_string of this thread write and read numbers with a point and no grouping,
/// whatever locale the process has set. Streams have a locale of their own: those below are made without it.
class PlainNumbers
{
public:
  PlainNumbers();
  ~PlainNumbers();
  PlainNumbers(const PlainNumbers&) = delete;
  PlainNumbers& operator=(const PlainNumbers&) = delete;

private:
  locale_t before_;
};

/// As printf's "%.*f", without the locale: 1234.50.
std::string fixedText(double value, int decimals);
/// As printf's "%.*g", without the locale; 17 digits read back as the same number.
std::string shortText(double value, int digits = 6);

/// Appends what printf writes, without the locale; what is beyond 255 characters is cut off.
__attribute__((format(printf, 2, 3))) void appendText(std::string& out, const char* format, ...);

/// The number that the whole text is, by C's rules and without the locale; nothing for text that is none, for one out
/// of range, and for "nan" and "inf".
std::optional<double> parseNumber(const std::string& text);
}  // namespace lidar_panoptic_clustering
