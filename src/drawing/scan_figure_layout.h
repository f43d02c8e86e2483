#pragma once

#include "drawing/birds_eye_view.h"

#include <vector>

namespace lidar_panoptic_clustering
{
/// Where everything of a figure stands [px].
struct ScanFigureLayout
{
  struct Panel
  {
    Box title;
    BirdsEyeView birds_eye_view;
    Box range_picture;  ///< of height 0 where the cloud has one row
  };

  double scale = 1.0;  ///< of text, lines and points
  int width = 0, height = 0;
  Box heading;  ///< of height 0 where there is neither title nor legend
  std::vector<Panel> panels;
};

/// Throws as drawScanFigure does.
ScanFigureLayout layOut(const std::vector<ScanPanel>& panels, const ScanFigureOptions& options);
}  // namespace lidar_panoptic_clustering
