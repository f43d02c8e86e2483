#pragma once

namespace lidar_panoptic_clustering
{
/// Of the library in use, "0.1.0".
const char* version();
}  // namespace lidar_panoptic_clustering
