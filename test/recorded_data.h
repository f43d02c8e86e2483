#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lidar_panoptic_clustering
{
/// The folder of recorded scans: $LIDAR_PANOPTIC_DATA, else ../shared/data beside the repository; "" where neither is.
inline std::string recordedData()
{
  const char* given = std::getenv("LIDAR_PANOPTIC_DATA");
  const std::string folder = given != nullptr ? given : "../shared/data";
  return std::filesystem::is_directory(folder) ? folder : "";
}
}  // namespace lidar_panoptic_clustering

/// Skips the test where the recorded scans are absent; else `folder` names them.
#define REQUIRE_RECORDED_DATA(folder)                                   \
  const std::string folder = lidar_panoptic_clustering::recordedData(); \
  if (folder.empty()) GTEST_SKIP() << "recorded scans not found: set LIDAR_PANOPTIC_DATA to their folder"
