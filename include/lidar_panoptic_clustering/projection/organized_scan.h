#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How a cloud's points became rows of scan lines.
enum class Layout
{
  kOrganized,  ///< the driver's rows or columns are the scan lines
  kRing,       ///< row by the field `ring`, column by azimuth
  kBeams,      ///< row by the sensor's beam elevations, column by azimuth
  kUnfold,     ///< points ring after ring as in KITTI's files, see RingCounter; column by azimuth
  kMerged      ///< no scan lines: one row, in the points' own order
};

/// A sensor's cloud as an organised labelled cloud, and the way back to its points.
///
/// Points are numbered as sent, row-major. Row 0 of the image is the highest beam. Organised clouds keep the order of
/// their firings; in the others column 0 looks backwards and the azimuth falls with the column, see Projection.
struct OrganizedScan
{
  Projection image;                   ///< for clouds that carry no labels, with label 0 until they are given
  std::vector<ScanPoint> points;      ///< as sent, by index; coordinates as they came, no returns included
  std::vector<std::uint32_t> labels;  ///< raw class ids by index; kUnreadableLabel where the sender's is no id
  Layout layout = Layout::kOrganized;
  bool organized_input = true;  ///< a point a pixel: none can be hidden
};

/// Gives the points of a scan labels that came from elsewhere: one a point, by sent index. Linear.
/// Throws std::invalid_argument when there are not as many labels as points.
void labelPoints(OrganizedScan& scan, const std::vector<std::uint32_t>& label_of_point);

/// The same with one label a pixel of image.cloud, row-major, as a network on the range image writes them; pixels
/// without a return get theirs too.
///
/// A return that its pixel does not show gets the label of the nearest returns that are shown, in 3-D: what stands
/// before it tells nothing of it. Looked for within two rows and two columns of its pixel, and a distance of two columns'
/// width, at least 0.1 m and at most 0.2 m; where nothing is so near, and where there is no return, it gets `no_class`.
/// Linear.
/// Throws std::invalid_argument when there are not as many labels as pixels.
void labelPixels(OrganizedScan& scan, const std::vector<std::uint32_t>& label_of_pixel, std::uint32_t no_class);
}  // namespace lidar_panoptic_clustering
