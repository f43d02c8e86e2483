#include "drawing/plot.h"

#include "core/plain_numbers.h"

#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
void check(const LineChart& chart)
{
  const std::string name = "line chart '" + chart.frame.title + "': series '";
  for (const LineChart::Series& series : chart.series)
    for (const LineChart::Point& point : series.points)
    {
      if (std::isinf(point.x) || std::isinf(point.y))
        throw std::invalid_argument(name + series.name + "' has an infinite value");
      if ((chart.x.logarithmic && point.x <= 0.0) || (chart.y.logarithmic && point.y <= 0.0))
        throw std::invalid_argument(name + series.name + "' has the point (" + shortText(point.x) + ", " +
                                    shortText(point.y) + "), expected values above 0 on a logarithmic axis");
    }
}

void drawSeries(Plot& plot, const AxisScale& x, const LineChart::Series& series, std::size_t index)
{
  const std::uint32_t rgb = colorOfSeries(series.rgb, index);
  std::vector<PixelPoint> stretch, all;
  const auto endStretch = [&]
  {
    if (series.line && stretch.size() > 1) plot.canvas().line(stretch, {rgb}, 2.6 * plot.scale());
    stretch.clear();
  };
  for (const LineChart::Point& point : series.points)
  {
    if (std::isnan(point.x) || std::isnan(point.y))
    {
      endStretch();
      continue;
    }
    stretch.push_back({plot.area().x + x.fraction(point.x) * plot.area().width, plot.toY(point.y)});
    all.push_back(stretch.back());
  }
  endStretch();
  if (!series.markers) return;
  for (const PixelPoint& at : all) drawMarker(plot.canvas(), at, static_cast<int>(index), 6.0 * plot.scale(), rgb);
}
}  // namespace

void drawChart(const LineChart& chart, const std::string& png_path)
{
  check(chart);
  std::vector<double> x_values, y_values;
  std::vector<LegendEntry> legend;
  for (std::size_t s = 0; s < chart.series.size(); ++s)
  {
    for (const LineChart::Point& point : chart.series[s].points)
    {
      if (std::isnan(point.x) || std::isnan(point.y)) continue;
      x_values.push_back(point.x);
      y_values.push_back(point.y);
    }
    const int marker = chart.series[s].markers ? static_cast<int>(s) : -1;
    legend.push_back({chart.series[s].name, colorOfSeries(chart.series[s].rgb, s), marker});
  }
  for (const ReferenceLine& reference : chart.frame.references)
    if (!chart.y.logarithmic || reference.value > 0.0) y_values.push_back(reference.value);

  const AxisScale x = scaleFor(chart.x, x_values, false, 10);
  Plot plot(chart.frame, legend, scaleFor(chart.y, y_values, false, 8), {0.0, 96.0});
  plot.drawYAxis(chart.y.title);
  plot.drawXAxis(x, chart.x.title);
  const double edge = 8.0 * plot.scale();  // a marker on the border stays whole
  const Box& area = plot.area();
  plot.canvas().clip({area.x - edge, area.y - edge, area.width + 2.0 * edge, area.height + 2.0 * edge});
  for (std::size_t s = 0; s < chart.series.size(); ++s) drawSeries(plot, x, chart.series[s], s);
  plot.canvas().unclip();
  plot.drawReferences();
  plot.canvas().writePng(png_path);
}
}  // namespace lidar_panoptic_clustering
