#pragma once

#include <string>

namespace lidar_panoptic_clustering
{
/// What errno's value means; unlike std::strerror, safe in several threads at once.
std::string systemError(int error);
}  // namespace lidar_panoptic_clustering
