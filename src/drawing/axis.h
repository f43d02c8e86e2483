#pragma once

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Multiples of 1, 2 or 5 times a power of ten, the finest such step with which at most `max_count` (>= 3) of them
/// cover [low, high]: the first is <= low and the last >= high. An empty or non-finite range is widened first.
std::vector<double> linearTicks(double low, double high, int max_count);

/// Powers of ten that cover [low, high], 0 < low <= high; 1, 2 and 5 times them where that is under two decades; the
/// first is <= low and the last >= high.
std::vector<double> logTicks(double low, double high);

/// A tick's value with the decimals `step` needs and commas between thousands: 0.25, 120,000.
std::string tickLabel(double value, double step);

/// With a fixed number of decimals and commas between thousands.
std::string numberLabel(double value, int decimals);
}  // namespace lidar_panoptic_clustering
