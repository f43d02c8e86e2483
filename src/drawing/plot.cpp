#include "drawing/plot.h"

#include "core/plain_numbers.h"

#include "drawing/axis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
// M. Okabe and K. Ito, Color Universal Design, 2008; the yellow, too light on white, is left out
constexpr std::array<std::uint32_t, 7> kPalette{0x0072B2, 0xE69F00, 0x009E73, 0xD55E00, 0xCC79A7, 0x56B4E9, 0x4D4D4D};
constexpr double kPi = 3.14159265358979323846;

void checkAxis(const Axis& axis)
{
  if (std::isinf(axis.min) || std::isinf(axis.max) || axis.min >= axis.max)
    throw std::invalid_argument("axis '" + axis.title + "': from " + shortText(axis.min) + " to " +
                                shortText(axis.max) + ", expected finite ends in rising order");
  if (axis.logarithmic && (axis.min <= 0.0 || axis.max <= 0.0))
    throw std::invalid_argument("axis '" + axis.title + "': logarithmic, expected ends above 0");
}
}  // namespace

double chartScale(const ChartFrame& frame)
{
  for (const int side : {frame.width_px, frame.height_px})
    if (side < 320 || side > 8192)
      throw std::invalid_argument("chart '" + frame.title + "': a side is " + std::to_string(side) +
                                  " px, expected 320..8192");
  return std::min(frame.height_px / 900.0, frame.width_px / 1000.0);
}

double AxisScale::fraction(double value) const
{
  const double first = ticks.front(), last = ticks.back();
  if (logarithmic) return std::log(value / first) / std::log(last / first);
  return (value - first) / (last - first);
}

std::vector<std::string> AxisScale::labels() const
{
  std::vector<std::string> labels;
  for (const double tick : ticks) labels.push_back(tickLabel(tick, logarithmic ? tick : ticks[1] - ticks[0]));
  return labels;
}

AxisScale scaleFor(const Axis& axis, const std::vector<double>& values, bool with_zero, int max_ticks)
{
  checkAxis(axis);
  double low = axis.min, high = axis.max;
  for (const double value : values)
  {
    if (!std::isfinite(value)) continue;
    if (std::isnan(axis.min)) low = std::fmin(low, value);
    if (std::isnan(axis.max)) high = std::fmax(high, value);
  }
  if (with_zero) low = std::fmin(low, 0.0), high = std::fmax(high, 0.0);
  AxisScale scale;
  scale.logarithmic = axis.logarithmic;
  scale.ticks = axis.logarithmic ? logTicks(low, high) : linearTicks(low, high, max_ticks);
  return scale;
}

std::uint32_t colorOfSeries(std::uint32_t rgb, std::size_t index)
{
  return rgb == kSeriesColor ? kPalette[index % kPalette.size()] : rgb & 0xFFFFFFU;
}

void drawMarker(Canvas& canvas, PixelPoint at, int marker, double radius, std::uint32_t rgb)
{
  const double r = radius, x = at.x, y = at.y;
  switch (marker % 6)
  {
    case 0:
      return canvas.disc(at, r, {rgb, 0.85});
    case 1:
      return canvas.fill(Box{x - 0.88 * r, y - 0.88 * r, 1.76 * r, 1.76 * r}, {rgb, 0.85});
    case 2:
      return canvas.fill({{x, y - 1.2 * r}, {x + 1.1 * r, y + 0.8 * r}, {x - 1.1 * r, y + 0.8 * r}}, {rgb, 0.85});
    case 3:
      return canvas.fill({{x, y - 1.3 * r}, {x + 1.3 * r, y}, {x, y + 1.3 * r}, {x - 1.3 * r, y}}, {rgb, 0.85});
    case 4:
      return canvas.fill({{x, y + 1.2 * r}, {x + 1.1 * r, y - 0.8 * r}, {x - 1.1 * r, y - 0.8 * r}}, {rgb, 0.85});
    default:
      canvas.line({{x - r, y - r}, {x + r, y + r}}, {rgb}, 0.5 * r);
      canvas.line({{x - r, y + r}, {x + r, y - r}}, {rgb}, 0.5 * r);
  }
}

Plot::Plot(const ChartFrame& frame, const std::vector<LegendEntry>& legend, AxisScale y, PlotRoom room)
    : frame_(frame), y_(std::move(y)), scale_(chartScale(frame)), canvas_(frame.width_px, frame.height_px, kChartPaper)
{
  double label_width = 0.0;
  for (const std::string& label : y_.labels())
    label_width = std::max(label_width, canvas_.textWidth(label, {18.0 * scale_, {}}));
  const double left = label_width + 84.0 * scale_, right = frame.width_px - 48.0 * scale_;
  const double legend_top = (frame.subtitle.empty() ? 76.0 : 104.0) * scale_;
  const double top = legend_top + (room.top + (legend.size() > 1 ? 44.0 : 0.0)) * scale_;
  area_ = {left, top, right - left, frame.height_px - room.bottom * scale_ - top};
  drawHeader();
  if (legend.size() > 1) drawLegend(legend, legend_top + 10.0 * scale_);
}

void Plot::drawHeader()
{
  const double left = 36.0 * scale_, room = area_.right() - left;
  canvas_.fittedText({left, 44.0 * scale_}, frame_.title, {28.0 * scale_, {kInk}, TextAlign::kLeft, true}, room);
  canvas_.fittedText({left, 80.0 * scale_}, frame_.subtitle, {19.0 * scale_, {kFaintInk}}, room);
}

void Plot::drawLegend(const std::vector<LegendEntry>& legend, double y)
{
  constexpr double kName = 1.4, kNext = 3.2;  // from the marker's left side to the name, and from name to name [em]
  TextStyle style{18.0 * scale_, {kInk}};
  double width = 0.0;
  for (const LegendEntry& entry : legend) width += canvas_.textWidth(entry.name, style) + kNext * style.size;
  style.size *= std::min(1.0, area_.width / width);

  double x = area_.x;
  for (const LegendEntry& entry : legend)
  {
    const double size = 0.9 * style.size;
    if (entry.marker < 0)
      canvas_.fill(Box{x, y - 0.5 * size, size, size}, {entry.rgb});
    else
      drawMarker(canvas_, {x + 0.5 * size, y}, entry.marker, 0.45 * size, entry.rgb);
    canvas_.text({x + kName * style.size, y}, entry.name, style);
    x += canvas_.textWidth(entry.name, style) + kNext * style.size;
  }
}

void Plot::drawYAxis(const std::string& title)
{
  const std::vector<std::string> labels = y_.labels();
  for (std::size_t i = 0; i < y_.ticks.size(); ++i)
  {
    const double y = std::round(toY(y_.ticks[i])) + 0.5;
    canvas_.line({{area_.x, y}, {area_.right(), y}}, {kGridLine}, 1.0);
    canvas_.text({area_.x - 12.0 * scale_, y}, labels[i], {18.0 * scale_, {kFaintInk}, TextAlign::kRight});
  }
  canvas_.text({34.0 * scale_, area_.y + 0.5 * area_.height}, title,
               {19.0 * scale_, {kInk}, TextAlign::kCentre, false, -0.5 * kPi});
}

void Plot::drawXAxis(const AxisScale& x, const std::string& title)
{
  const std::vector<std::string> labels = x.labels();
  for (std::size_t i = 0; i < x.ticks.size(); ++i)
  {
    const double at = std::round(area_.x + x.fraction(x.ticks[i]) * area_.width) + 0.5;
    canvas_.line({{at, area_.y}, {at, area_.bottom()}}, {kGridLine}, 1.0);
    canvas_.text({at, area_.bottom() + 22.0 * scale_}, labels[i], {18.0 * scale_, {kFaintInk}, TextAlign::kCentre});
  }
  canvas_.line({{area_.x, area_.bottom()}, {area_.right(), area_.bottom()}}, {kFaintInk}, 1.4 * scale_);
  canvas_.text({area_.x + 0.5 * area_.width, area_.bottom() + 60.0 * scale_}, title,
               {19.0 * scale_, {kInk}, TextAlign::kCentre});
}

void Plot::drawReferences()
{
  for (const ReferenceLine& reference : frame_.references)
  {
    const double y = toY(reference.value);
    if (!(y >= area_.y - 1.0 && y <= area_.bottom() + 1.0)) continue;
    canvas_.line({{area_.x, y}, {area_.right(), y}}, {kFaintInk}, 1.6 * scale_, true);
    canvas_.textOnPlate({area_.right() - 6.0 * scale_, y - 16.0 * scale_}, reference.text,
                        {17.0 * scale_, {kFaintInk}, TextAlign::kRight}, {kChartPaper, 0.8});
  }
}
}  // namespace lidar_panoptic_clustering
