#pragma once

#include "lidar_panoptic_clustering/projection/layout_probe.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"

namespace lidar_panoptic_clustering
{
/// How a driver's rows and columns lie in the image.
struct RowPlacement
{
  Orientation orientation = Orientation::kRowsAreRings;
  bool highest_first = true;  ///< else the first scan line becomes the last row
};

/// Reads an organised cloud point by point into its pixels; a pixel without a return has NaN coordinates. Fills all of
/// `out` but the header. One pass over the message; linear, reuses the memory of `out`.
void placeRows(const RawCloud& raw, const ScanFields& fields, const RowPlacement& placement, OrganizedScan& out);
}  // namespace lidar_panoptic_clustering
