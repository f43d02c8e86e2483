#include "lidar_panoptic_clustering/core/version.h"

#include "shipped_files.h"

namespace lidar_panoptic_clustering
{
const char* version()
{
  return kVersion;
}
}  // namespace lidar_panoptic_clustering
