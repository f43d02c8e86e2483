#include "drawing/axis.h"

#include "core/plain_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::array<int, 3> kFactors{1, 2, 5};

/// The value of k steps without the rounding of a repeated sum: 3 * 0.1 is 0.3, not 0.30000000000000004.
double multiple(double k, int factor, int exponent)
{
  return exponent < 0 ? k * factor / std::pow(10.0, -exponent) : k * factor * std::pow(10.0, exponent);
}

double power(int exponent)
{
  return multiple(1.0, 1, exponent);
}
}  // namespace

std::vector<double> linearTicks(double low, double high, int max_count)
{
  if (!std::isfinite(low) || !std::isfinite(high)) low = 0.0, high = 1.0;
  if (low > high) std::swap(low, high);
  if (high - low <= 1e-12 * std::max(std::abs(low), std::abs(high))) high = low + std::max(1.0, std::abs(low));
  max_count = std::max(3, max_count);  // two cannot cover a range with 0 inside

  // rounding in low / step must not add a tick beside one that stands on the border
  constexpr double kSlack = 1e-9;
  for (int exponent = static_cast<int>(std::floor(std::log10((high - low) / max_count)));; ++exponent)
    for (const int factor : kFactors)
    {
      const double step = multiple(1.0, factor, exponent);
      const double first = std::floor(low / step + kSlack), last = std::ceil(high / step - kSlack);
      if (last - first + 1.0 > max_count) continue;
      std::vector<double> ticks;
      for (double k = first; k <= last; k += 1.0) ticks.push_back(multiple(k, factor, exponent));
      return ticks;
    }
}

std::vector<double> logTicks(double low, double high)
{
  if (!(low > 0.0) || !std::isfinite(low) || !(high >= low) || !std::isfinite(high)) low = 1.0, high = 10.0;
  constexpr double kSlack = 1e-9;
  const int first = static_cast<int>(std::floor(std::log10(low) + kSlack));
  const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high) - kSlack)));
  const bool only_powers = high / low >= 100.0;

  std::vector<double> candidates;
  for (int exponent = first; exponent <= last; ++exponent)
    for (const int factor : kFactors)
      if (factor == 1 || !only_powers) candidates.push_back(factor * power(exponent));
  const auto begin = std::upper_bound(candidates.begin(), candidates.end(), low * (1.0 + kSlack)) - 1;
  const auto end = std::lower_bound(candidates.begin(), candidates.end(), high * (1.0 - kSlack)) + 1;
  return {begin, std::max(end, begin + 2)};
}

std::string tickLabel(double value, double step)
{
  const double size = std::abs(step);
  const int decimals = size > 0.0 && size < 1.0 ? static_cast<int>(std::ceil(-std::log10(size) - 1e-9)) : 0;
  return numberLabel(value, std::min(decimals, 9));
}

std::string numberLabel(double value, int decimals)
{
  std::string digits = fixedText(std::abs(value), decimals);
  if (!std::isfinite(value)) return digits;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  for (std::size_t i = point; i > 3; i -= 3) digits.insert(i - 3, ",");
  const bool zero = digits.find_first_of("123456789") == std::string::npos;
  return value < 0.0 && !zero ? "-" + digits : digits;
}
}  // namespace lidar_panoptic_clustering
