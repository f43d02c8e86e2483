#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>

namespace lidar_panoptic_clustering
{
/// The k-th colour (0x00RRGGBB) of an endless series of bright, well separated hues.
std::uint32_t seriesColor(std::uint32_t k);
}  // namespace lidar_panoptic_clustering
