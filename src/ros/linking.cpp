#include "ros/linking.h"

namespace lidar_panoptic_clustering
{
std::mutex& linkMutex()
{
  static std::mutex mutex;
  return mutex;
}
}  // namespace lidar_panoptic_clustering
