#pragma once

#include "drawing/canvas.h"
#include "lidar_panoptic_clustering/drawing/chart.h"

#include <array>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
constexpr std::uint32_t kInk = 0x1F2933, kFaintInk = 0x5B6770, kGridLine = 0xDDE2E7, kChartPaper = 0xFFFFFF;

/// A value's place along an axis: ticks cover the axis from end to end.
struct AxisScale
{
  std::vector<double> ticks;
  bool logarithmic = false;

  /// 0 at the first tick, 1 at the last.
  double fraction(double value) const;
  std::vector<std::string> labels() const;
};

/// Ticks for the finite values in `values`; `with_zero` puts 0 on the axis.
AxisScale scaleFor(const Axis& axis, const std::vector<double>& values, bool with_zero, int max_ticks);

/// The colour of series `index`: its own, or one of Okabe and Ito's palette.
std::uint32_t colorOfSeries(std::uint32_t rgb, std::size_t index);

struct LegendEntry
{
  std::string name;
  std::uint32_t rgb = 0;
  int marker = -1;  ///< as drawMarker; -1: a bar's square
};

/// Circle, square, triangle, diamond, triangle down, cross; then again.
void drawMarker(Canvas& canvas, PixelPoint at, int marker, double radius, std::uint32_t rgb);

/// The factor for text and lines of a chart of this size: 1 at a height of 900 px.
/// Throws std::invalid_argument when a side is out of range.
double chartScale(const ChartFrame& frame);

/// Kept free between legend and plot, and below the x axis [px at a scale of 1].
struct PlotRoom
{
  double top = 0.0, bottom = 56.0;
};

/// The page around the values: title, legend, axes.
class Plot
{
public:
  /// Throws as chartScale does.
  Plot(const ChartFrame& frame, const std::vector<LegendEntry>& legend, AxisScale y, PlotRoom room);

  /// Grid lines, tick labels and titles; call before drawing values.
  void drawYAxis(const std::string& title);
  void drawXAxis(const AxisScale& x, const std::string& title);
  /// Call after drawing values.
  void drawReferences();

  Canvas& canvas() { return canvas_; }
  const Box& area() const { return area_; }
  double scale() const { return scale_; }
  double toY(double value) const { return area_.bottom() - y_.fraction(value) * area_.height; }

private:
  void drawHeader();
  void drawLegend(const std::vector<LegendEntry>& legend, double y);

  ChartFrame frame_;
  AxisScale y_;
  double scale_;
  Canvas canvas_;
  Box area_;
};
}  // namespace lidar_panoptic_clustering
