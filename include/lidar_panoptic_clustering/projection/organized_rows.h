#pragma once

#include "lidar_panoptic_clustering/projection/layout_probe.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How a driver's rows and columns lie in the image.
struct RowPlacement
{
  Orientation orientation = Orientation::kRowsAreRings;
  std::vector<std::uint32_t> row_of_line;  ///< by the driver's scan line its row; empty: as they come
};

/// Reads an organised cloud point by point into its pixels; a pixel without a return has NaN coordinates. Fills all of
/// `out` but the header. One pass over the message; linear, reuses the memory of `out`.
void placeRows(const RawCloud& raw, const ScanFields& fields, const RowPlacement& placement, OrganizedScan& out);
}  // namespace lidar_panoptic_clustering
