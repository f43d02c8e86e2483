#include "drawing/axis.h"
#include "drawing/plot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPi = 3.14159265358979323846, kCategorySize = 18.0, kValueSize = 17.0;
constexpr double kSlant = -0.2 * kPi;  // of category names that do not fit side by side

void check(const BarChart& chart)
{
  const std::string name = "bar chart '" + chart.frame.title + "': ";
  if (chart.y.logarithmic) throw std::invalid_argument(name + "bars start at 0, expected a linear axis");
  for (const BarChart::Series& series : chart.series)
  {
    if (series.values.size() != chart.categories.size())
      throw std::invalid_argument(name + "series '" + series.name + "' has " + std::to_string(series.values.size()) +
                                  " values, expected one for each of " + std::to_string(chart.categories.size()) +
                                  " categories");
    for (const double value : series.values)
      if (std::isinf(value)) throw std::invalid_argument(name + "series '" + series.name + "' has an infinite value");
  }
}

/// What the bars' places follow from [px].
struct Slots
{
  double left, category, bar;  ///< the first category's left side; widths

  double barLeft(std::size_t c, std::size_t s, std::size_t series_count) const
  {
    return left + (static_cast<double>(c) + 0.5) * category +
           (static_cast<double>(s) - 0.5 * static_cast<double>(series_count)) * bar;
  }
};

Slots slotsOf(const BarChart& chart, double left, double width)
{
  const double categories = static_cast<double>(std::max<std::size_t>(1, chart.categories.size()));
  const double series = static_cast<double>(std::max<std::size_t>(1, chart.series.size()));
  const double category = width / categories;
  return {left, category, std::min(0.8 * category / series, 150.0 * chartScale(chart.frame))};
}

/// How the texts at the bars stand, which decides the room around the plot.
struct TextPlan
{
  double value_size = 0.0;  ///< em [px]
  bool values_upright = false;
  bool categories_slanted = false;
  PlotRoom room;
};

TextPlan planTexts(const BarChart& chart)
{
  const double scale = chartScale(chart.frame);
  const Slots slots = slotsOf(chart, 0.0, chart.frame.width_px - 160.0 * scale);
  Canvas ruler(1, 1, kChartPaper);
  TextPlan plan;
  plan.value_size = std::clamp(0.9 * slots.bar, 0.5 * kValueSize * scale, kValueSize * scale);

  double value_width = 0.0, category_width = 0.0;
  if (chart.decimals >= 0)
    for (const BarChart::Series& series : chart.series)
      for (const double value : series.values)
        value_width = std::max(value_width, ruler.textWidth(numberLabel(value, chart.decimals), {plan.value_size, {}}));
  for (const std::string& category : chart.categories)
    category_width = std::max(category_width, ruler.textWidth(category, {kCategorySize * scale, {}}));

  plan.values_upright = value_width > slots.bar;
  plan.categories_slanted = category_width > 0.95 * slots.category;
  if (plan.values_upright) plan.room.top = value_width / scale;
  plan.room.bottom = plan.categories_slanted ? 48.0 + category_width / scale * std::sin(-kSlant) : 56.0;
  return plan;
}

void drawBars(Plot& plot, const BarChart& chart, const Slots& slots)
{
  const double gap = slots.bar > 8.0 * plot.scale() ? 0.06 * slots.bar : 0.0;
  for (std::size_t s = 0; s < chart.series.size(); ++s)
    for (std::size_t c = 0; c < chart.categories.size(); ++c)
    {
      const double value = chart.series[s].values[c];
      if (std::isnan(value)) continue;
      const double left = slots.barLeft(c, s, chart.series.size()), end = plot.toY(value), zero = plot.toY(0.0);
      plot.canvas().fill(Box{left + gap, std::min(end, zero), slots.bar - 2.0 * gap, std::abs(zero - end)},
                         {colorOfSeries(chart.series[s].rgb, s)});
    }
}

/// Values above their bars.
void drawValues(Plot& plot, const BarChart& chart, const Slots& slots, const TextPlan& plan)
{
  if (chart.decimals < 0) return;
  TextStyle style{plan.value_size, {kInk}, TextAlign::kCentre};
  if (plan.values_upright) style.align = TextAlign::kLeft, style.angle = -0.5 * kPi;
  for (std::size_t s = 0; s < chart.series.size(); ++s)
    for (std::size_t c = 0; c < chart.categories.size(); ++c)
    {
      const double value = chart.series[s].values[c];
      if (std::isnan(value)) continue;
      const double x = slots.barLeft(c, s, chart.series.size()) + 0.5 * slots.bar;
      const double top = std::max(plot.toY(std::max(value, 0.0)), plot.area().y);
      plot.canvas().text({x, top - (plan.values_upright ? 6.0 : 14.0) * plot.scale()},
                         numberLabel(value, chart.decimals), style);
    }
}

void drawCategories(Plot& plot, const BarChart& chart, const Slots& slots, bool slanted)
{
  TextStyle style{kCategorySize * plot.scale(), {kInk}, TextAlign::kCentre};
  if (slanted) style.align = TextAlign::kRight, style.angle = kSlant;
  for (std::size_t c = 0; c < chart.categories.size(); ++c)
  {
    const double x = slots.left + (static_cast<double>(c) + 0.5) * slots.category;
    plot.canvas().text({x, plot.area().bottom() + 22.0 * plot.scale()}, chart.categories[c], style);
  }
  const double zero = plot.toY(0.0);
  plot.canvas().line({{plot.area().x, zero}, {plot.area().right(), zero}}, {kFaintInk}, 1.4 * plot.scale());
}
}  // namespace

void drawChart(const BarChart& chart, const std::string& png_path)
{
  check(chart);
  std::vector<double> values;
  std::vector<LegendEntry> legend;
  for (std::size_t s = 0; s < chart.series.size(); ++s)
  {
    values.insert(values.end(), chart.series[s].values.begin(), chart.series[s].values.end());
    legend.push_back({chart.series[s].name, colorOfSeries(chart.series[s].rgb, s)});
  }
  for (const ReferenceLine& reference : chart.frame.references) values.push_back(reference.value);

  const TextPlan plan = planTexts(chart);
  Plot plot(chart.frame, legend, scaleFor(chart.y, values, true, 8), plan.room);
  const Slots slots = slotsOf(chart, plot.area().x, plot.area().width);
  plot.drawYAxis(chart.y.title);
  plot.canvas().clip(plot.area());
  drawBars(plot, chart, slots);
  plot.canvas().unclip();
  plot.drawReferences();
  drawValues(plot, chart, slots, plan);
  drawCategories(plot, chart, slots, plan.categories_slanted);
  plot.canvas().writePng(png_path);
}
}  // namespace lidar_panoptic_clustering
