#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/drawing/named_box.h"

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Where a street picture is seen from [m, sensor frame: x ahead, y left, z up].
struct Camera
{
  double x = -13.0, y = 0.0, z = 8.5;                    ///< the eye
  double target_x = 14.0, target_y = 0.0, target_z = 0;  ///< what is in the middle of the picture
  double field_of_view_deg = 60.0;                       ///< from the left edge to the right one, 10 to 150
};

/// How drawStreetPicture draws.
struct StreetPictureOptions
{
  Camera camera;
  int width_px = 1600, height_px = 720;  ///< each 160..8192; points, lines and text grow with the width
  double farthest_named_m = 45.0;        ///< boxes farther from the eye stand without their text
};

/// Draws a scan in perspective: points with an instance in their own colour (PanopticPoint::rgb), the others in a
/// dimmed one, near points larger than far ones; boxes as translucent frames with their text above them. Texts do not
/// cover each other: the nearer box keeps its own.
///
/// n log n in the points. The file is written aside and renamed. Throws std::invalid_argument when a size or the field
/// of view is out of range, or the eye lies straight above, below or at its target; std::runtime_error naming
/// `png_path` when it cannot be written.
void drawStreetPicture(const PanopticCloud& cloud, const std::vector<NamedBox>& boxes, const std::string& png_path,
                       const StreetPictureOptions& options = {});
}  // namespace lidar_panoptic_clustering
