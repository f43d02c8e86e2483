#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <string>

namespace lidar_panoptic_clustering
{
/// An upright box to be drawn around an object, and what stands beside it.
struct NamedBox
{
  float x = 0.0F, y = 0.0F, z = 0.0F;                ///< centre [m], sensor frame
  float length = 0.0F, width = 0.0F, height = 0.0F;  ///< full extents [m]; length along the box's own x axis
  float yaw = 0.0F;                                  ///< of that axis about z [rad]
  std::uint32_t rgb = 0xFFFFFF;                      ///< 0x00RRGGBB
  std::string text;                                  ///< short, e.g. "car 12"; none when empty
};
}  // namespace lidar_panoptic_clustering
