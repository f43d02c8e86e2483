#include "core/plain_numbers.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
std::string print(const char* pattern, int precision, double value)
{
  const PlainNumbers plain;
  char text[std::numeric_limits<double>::max_exponent10 + 64];
  std::snprintf(text, sizeof text, pattern, precision, value);
  return text;
}
}  // namespace

PlainNumbers::PlainNumbers()
{
  static const locale_t plain = newlocale(LC_NUMERIC_MASK, "C", nullptr);  // as long as the program
  before_ = uselocale(plain);
}

PlainNumbers::~PlainNumbers()
{
  uselocale(before_);
}

std::string fixedText(double value, int decimals)
{
  return print("%.*f", decimals, value);
}

std::string shortText(double value, int digits)
{
  return print("%.*g", digits, value);
}

void appendText(std::string& out, const char* format, ...)
{
  const PlainNumbers plain;
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out += line;
}

std::optional<double> parseNumber(const std::string& text)
{
  if (text.find_first_not_of("0123456789+-.eE") != std::string::npos || text.empty()) return std::nullopt;
  const PlainNumbers plain;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}
}  // namespace lidar_panoptic_clustering
