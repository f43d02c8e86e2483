#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/drawing/named_box.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A ring around a place in bird's-eye view, e.g. an object that was wrongly split or merged.
struct Mark
{
  float x = 0.0F, y = 0.0F;      ///< centre [m], sensor frame
  float radius_m = 2.0F;         ///< of the ring
  std::uint32_t rgb = 0xFF4040;  ///< 0x00RRGGBB
  std::string text;              ///< short; stands beside the ring
};

/// The way an object has come, drawn in bird's-eye view; it fades to its beginning.
struct Trail
{
  /// A place on the ground [m], sensor frame.
  struct Place
  {
    float x = 0.0F, y = 0.0F;  ///< [m]
  };
  std::vector<Place> places;     ///< the oldest first
  std::uint32_t rgb = 0xFFFFFF;  ///< 0x00RRGGBB
};

/// One clustered scan of a figure.
struct ScanPanel
{
  std::string title;                     ///< e.g. the algorithm's name
  const PanopticCloud* cloud = nullptr;  ///< row-major, height = scan lines; has to outlive the call
  std::vector<Mark> marks;               ///< over the points
  std::string caption;                   ///< stands after the counts of returns, thing points and instances
  std::vector<NamedBox> boxes{};         ///< drawn around the objects, from above; text beside them
  std::vector<Trail> trails{};           ///< under the boxes
};

/// What the marks of a colour mean, for the legend.
struct MarkMeaning
{
  std::uint32_t rgb = 0;  ///< 0x00RRGGBB
  std::string text;       ///< short
};

/// The part of the ground a bird's-eye view shows [m], sensor frame.
struct ViewWindow
{
  double min_x = -50.0, max_x = 50.0, min_y = -25.0, max_y = 25.0;  ///< what is seen, ends included

  /// Along x [m].
  double width() const { return max_x - min_x; }
  /// Along y [m].
  double height() const { return max_y - min_y; }
};

/// How drawScanFigure draws.
struct ScanFigureOptions
{
  std::string title;                     ///< above all panels; none when empty
  std::vector<MarkMeaning> mark_legend;  ///< what the marks' colours mean
  int panel_width_px = 1280;             ///< 320..8192; text and points grow with it
  int columns = 0;                       ///< panels side by side; 0: up to three in one row, else near a square
  std::optional<ViewWindow> window{};    ///< what is seen from above; none: the window that suits the objects
  bool range_images = true;              ///< below the view from above
  bool counts = true;                    ///< returns, thing points and instances before the caption
};

/// Draws scans as the literature shows them: the cloud from above and, below it, its range image.
///
/// Points with an instance have their own colour (PanopticPoint::rgb); the others are faint: in a dimmed class colour
/// from above, grey by range in the range image. From above, x points right and y up, range circles are in metres, and
/// all panels show the same window: the one of the options, else the middle 99 % of the points with an instance and the
/// sensor, within 80 m; 50 m around the sensor where there is no instance. The range image has the highest beam on top
/// whatever the ring order, and one picture column may stand for several firings: the nearest return on an object is
/// shown, else the nearest return. A cloud of one row has no range image. No return is NaN, infinity or exactly (0, 0,
/// 0).
///
/// Linear in the points. The file is written aside and renamed. Throws std::invalid_argument when there is no panel, a
/// cloud is missing, a cloud's size contradicts its points, an option is out of range, a window is empty or the
/// picture would be larger than 32767 px; std::runtime_error naming `png_path` when it cannot be written.
void drawScanFigure(const std::vector<ScanPanel>& panels, const std::string& png_path,
                    const ScanFigureOptions& options = {});
}  // namespace lidar_panoptic_clustering
