#pragma once

#include "drawing/canvas.h"
#include "lidar_panoptic_clustering/core/point_types.h"

namespace lidar_panoptic_clustering
{
/// The height in which a range image of this size is readable at a given picture width [px]: a whole number of pixels
/// a row where there is room, less than one where there are too many rows; 0 for a cloud of one row.
int rangePictureHeight(const PanopticCloud& cloud, int width_px);

/// Fills `box` with the range image: highest beam on top, instances in their colour, other returns grey by range.
void drawRangePicture(Canvas& canvas, const Box& box, const PanopticCloud& cloud);

/// Below the range image, where front, left, back and right are. `scale` multiplies the size of text and lines.
void drawHeadings(Canvas& canvas, const Box& box, const PanopticCloud& cloud, double scale);
}  // namespace lidar_panoptic_clustering
