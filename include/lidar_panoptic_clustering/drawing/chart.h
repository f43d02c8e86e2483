#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Lets the chart choose: a colour of a palette that colour-blind readers can tell apart.
constexpr std::uint32_t kSeriesColor = 0xFF000000;

/// Lets the chart choose an end of an axis from the values.
constexpr double kFromValues = std::numeric_limits<double>::quiet_NaN();

struct Axis
{
  std::string title;  ///< with the unit: "time [ms]"
  bool logarithmic = false;
  double min = kFromValues, max = kFromValues;  ///< rounded outwards to the next tick
};

/// A dashed line across the chart, e.g. a time limit.
struct ReferenceLine
{
  double value = 0.0;  ///< on the y axis
  std::string text;
};

/// What all charts share.
struct ChartFrame
{
  std::string title;
  std::string subtitle;  ///< e.g. data and machine; none when empty
  std::vector<ReferenceLine> references;
  int width_px = 1600, height_px = 900;  ///< each 320..8192
};

/// Grouped bars: in each category one bar a series.
struct BarChart
{
  struct Series
  {
    std::string name;
    std::vector<double> values;  ///< one a category; NaN draws no bar
    std::uint32_t rgb = kSeriesColor;
  };

  ChartFrame frame;
  Axis y;  ///< linear; 0 is always on it
  std::vector<std::string> categories;
  std::vector<Series> series;
  int decimals = 1;  ///< of the values written at the bars; below 0 writes none
};

/// Lines, points or both.
struct LineChart
{
  struct Point
  {
    double x = 0.0, y = 0.0;  ///< where either is NaN there is no point and the line is broken
  };
  struct Series
  {
    std::string name;
    std::vector<Point> points;  ///< lines join them in this order
    bool line = true;
    bool markers = true;
    std::uint32_t rgb = kSeriesColor;
  };

  ChartFrame frame;
  Axis x, y;
  std::vector<Series> series;
};

/// Draws the chart as a PNG, written aside and renamed. A legend stands on top when there are two series or more.
/// Throws std::invalid_argument when a series' values do not fit the categories, a value is infinite, a logarithmic
/// axis meets a value that is not above 0, or a size is out of range; each names the chart and the series.
/// Throws std::runtime_error naming `png_path` when it cannot be written.
void drawChart(const BarChart& chart, const std::string& png_path);
void drawChart(const LineChart& chart, const std::string& png_path);
}  // namespace lidar_panoptic_clustering
