#pragma once

#include "drawing/canvas.h"
#include "lidar_panoptic_clustering/drawing/scan_figure.h"

#include <cmath>
#include <vector>

namespace lidar_panoptic_clustering
{
inline bool isReturn(const PanopticPoint& p)
{
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && (p.x != 0.0F || p.y != 0.0F || p.z != 0.0F);
}

/// The window that suits all panels, see drawScanFigure; its height is 0.45 to 0.75 of its width.
ViewWindow viewWindow(const std::vector<ScanPanel>& panels);

/// Bird's-eye view: x to the right, y up.
struct BirdsEyeView
{
  Box box;
  ViewWindow window;

  double pixelsPerMetre() const { return box.width / window.width(); }
  PixelPoint toPixel(double x, double y) const
  {
    return {box.x + (x - window.min_x) * pixelsPerMetre(), box.y + (window.max_y - y) * pixelsPerMetre()};
  }
};

/// `scale` multiplies the size of text, lines and points.
void drawBirdsEyeView(Canvas& canvas, const BirdsEyeView& view, const ScanPanel& panel, double scale);
}  // namespace lidar_panoptic_clustering
