#pragma once

#include "lidar_panoptic_clustering/core/language.h"

namespace lidar_panoptic_clustering
{
/// Of the library in use, "0.1.0".
const char* version();
}  // namespace lidar_panoptic_clustering
