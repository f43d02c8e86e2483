#pragma once

#include <string>

namespace lidar_panoptic_clustering
{
/// The finest of 1, 2 or 5 times a power of ten of which at most `max_count` (>= 2) reach over `length`; for a length
/// that is not above 0, 1.
double roundStep(double length, int max_count);

/// A multiple of `step` with the decimals that step needs, as roundNumber().
std::string stepLabel(double value, double step);

/// With a fixed number of decimals and commas between thousands: 120,000.
std::string roundNumber(double value, int decimals);
}  // namespace lidar_panoptic_clustering
