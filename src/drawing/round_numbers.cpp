#include "drawing/round_numbers.h"

#include "core/plain_numbers.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
double roundStep(double length, int max_count)
{
  if (!std::isfinite(length) || length <= 0.0) return 1.0;
  max_count = std::max(2, max_count);

  // rounding in length / step must not refuse a step that fits exactly
  constexpr double kSlack = 1e-9;
  for (int exponent = static_cast<int>(std::floor(std::log10(length / (max_count + 1))));; ++exponent)
    for (const int factor : {1, 2, 5})
    {
      // divided where the power is below 1: 0.3 and not 0.30000000000000004
      const double step = exponent < 0 ? factor / std::pow(10.0, -exponent) : factor * std::pow(10.0, exponent);
      if (std::ceil(length / step - kSlack) <= max_count) return step;
    }
}

std::string stepLabel(double value, double step)
{
  const double size = std::abs(step);
  const int decimals = size > 0.0 && size < 1.0 ? static_cast<int>(std::ceil(-std::log10(size) - 1e-9)) : 0;
  return roundNumber(value, std::min(decimals, 9));
}

std::string roundNumber(double value, int decimals)
{
  std::string digits = fixedText(std::abs(value), decimals);
  if (!std::isfinite(value)) return digits;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  for (std::size_t i = point; i > 3; i -= 3) digits.insert(i - 3, ",");
  const bool zero = digits.find_first_of("123456789") == std::string::npos;
  return value < 0.0 && !zero ? "-" + digits : digits;
}
}  // namespace lidar_panoptic_clustering
