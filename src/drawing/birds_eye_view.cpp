#include "drawing/birds_eye_view.h"

#include "drawing/round_numbers.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kReachM = 80.0, kEmptyReachM = 50.0, kMarginM = 4.0, kMinWidthM = 40.0;
constexpr double kMinAspect = 0.45, kMaxAspect = 0.75;
constexpr std::uint32_t kBackground = 0x0B0E14, kGrid = 0x5C6B80, kText = 0xAEBBCB, kWhite = 0xFFFFFF;

/// The range of the middle 99 %, and 0, where the sensor stands.
std::pair<double, double> middleRange(std::vector<float>& values)
{
  const std::size_t cut = values.size() / 200;
  std::nth_element(values.begin(), values.begin() + cut, values.end());
  const double low = values[cut];
  std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
  const double high = *(values.end() - 1 - cut);
  return {std::clamp(low, -kReachM, 0.0), std::clamp(high, 0.0, kReachM)};
}

void widen(double& low, double& high, double size)
{
  const double missing = std::max(0.0, size - (high - low));
  low -= 0.5 * missing, high += 0.5 * missing;
}

/// Half way to grey and dark, so that the instances stand out.
std::uint32_t faint(std::uint32_t rgb)
{
  const std::uint32_t r = (rgb >> 16) & 0xFFU, g = (rgb >> 8) & 0xFFU, b = rgb & 0xFFU, grey = (r + g + b) / 3U;
  const auto channel = [grey](std::uint32_t value) { return 46U + (grey + value) / 9U; };
  return channel(r) << 16 | channel(g) << 8 | channel(b);
}

void drawPoints(Canvas& canvas, const BirdsEyeView& view, const PanopticCloud& cloud, double scale)
{
  const int stuff_size = std::max(1, static_cast<int>(std::lround(1.6 * scale)));
  const int thing_size = std::max(2, static_cast<int>(std::lround(3.6 * scale)));
  std::vector<Dot> stuff, things;
  for (const PanopticPoint& point : cloud)
  {
    if (!isReturn(point)) continue;
    const PixelPoint place = view.toPixel(point.x, point.y);
    if (!view.box.contains(place.x, place.y)) continue;
    const int x = static_cast<int>(place.x), y = static_cast<int>(place.y);
    if (point.instance > 0)
      things.push_back({x, y, thing_size, point.rgb});
    else
      stuff.push_back({x, y, stuff_size, faint(point.rgb)});
  }
  canvas.dots(stuff, view.box);
  canvas.dots(things, view.box);
}

/// Where a circle's label stands: on an axis, clear of the window's edge.
std::optional<PixelPoint> labelPlace(const BirdsEyeView& view, double radius, double clearance)
{
  const std::array<std::array<double, 2>, 4> directions{{{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};
  for (const auto& direction : directions)
  {
    const PixelPoint place = view.toPixel(direction[0] * radius, direction[1] * radius);
    if (view.box.contains(place.x - clearance, place.y - clearance) &&
        view.box.contains(place.x + clearance, place.y + clearance))
      return place;
  }
  return std::nullopt;
}

double circleStep(const ViewWindow& window)
{
  const double reach = std::max({-window.min_x, window.max_x, -window.min_y, window.max_y});
  return roundStep(reach, 5);
}

void drawRangeCircles(Canvas& canvas, const BirdsEyeView& view, double scale)
{
  const PixelPoint sensor = view.toPixel(0.0, 0.0);
  const double step = circleStep(view.window);
  const double farthest =
      std::hypot(std::max(-view.window.min_x, view.window.max_x), std::max(-view.window.min_y, view.window.max_y));
  for (double radius = step; radius < farthest; radius += step)
    canvas.circle(sensor, radius * view.pixelsPerMetre(), {kGrid, 0.55}, scale);
}

void drawRangeLabels(Canvas& canvas, const BirdsEyeView& view, double scale)
{
  const double step = circleStep(view.window);
  const TextStyle style{13.0 * scale, {kText}, TextAlign::kCentre};
  for (double radius = step; radius < 2.0 * kReachM; radius += step)
    if (const auto place = labelPlace(view, radius, 24.0 * scale))
      canvas.textOnPlate(*place, stepLabel(radius, step) + " m", style, {kBackground, 0.75});
}

void drawSensor(Canvas& canvas, const BirdsEyeView& view, double scale)
{
  const PixelPoint at = view.toPixel(0.0, 0.0);
  const double size = 9.0 * scale;
  const auto arrow = [&at](double s) -> std::vector<PixelPoint> {
    return {{at.x + 1.2 * s, at.y}, {at.x - s, at.y - 0.8 * s}, {at.x - 0.5 * s, at.y}, {at.x - s, at.y + 0.8 * s}};
  };
  canvas.fill(arrow(1.5 * size), {kBackground});
  canvas.fill(arrow(size), {kWhite});
}

void drawScaleBar(Canvas& canvas, const BirdsEyeView& view, double scale)
{
  const double metres = roundStep(0.2 * view.window.width(), 2);
  const double length = metres * view.pixelsPerMetre(), margin = 18.0 * scale;
  const Box plate{view.box.x + margin, view.box.bottom() - margin - 34.0 * scale, length + 20.0 * scale, 34.0 * scale};
  const double left = plate.x + 10.0 * scale, y = plate.bottom() - 9.0 * scale, tick = 5.0 * scale;
  canvas.fill(plate, {kBackground, 0.75});
  canvas.line({{left, y - tick}, {left, y}, {left + length, y}, {left + length, y - tick}}, {kWhite, 0.9}, 1.6 * scale);
  canvas.text({left + 0.5 * length, y - 14.0 * scale}, stepLabel(metres, metres) + " m",
              {13.0 * scale, {kWhite, 0.9}, TextAlign::kCentre});
}

void drawTrails(Canvas& canvas, const BirdsEyeView& view, const std::vector<Trail>& trails, double scale)
{
  for (const Trail& trail : trails)
    for (std::size_t i = 1; i < trail.places.size(); ++i)
    {
      const Trail::Place &from = trail.places[i - 1], &to = trail.places[i];
      const double alpha = static_cast<double>(i + 1) / static_cast<double>(trail.places.size());
      canvas.line({view.toPixel(from.x, from.y), view.toPixel(to.x, to.y)}, {trail.rgb, alpha}, 3.0 * scale);
    }
}

void drawBoxes(Canvas& canvas, const BirdsEyeView& view, const std::vector<NamedBox>& boxes, double scale)
{
  for (const NamedBox& box : boxes)
  {
    const double c = std::cos(box.yaw), s = std::sin(box.yaw);
    const auto corner = [&](double along, double across)
    {
      const double x = 0.5 * along * box.length, y = 0.5 * across * box.width;
      return view.toPixel(box.x + c * x - s * y, box.y + s * x + c * y);
    };
    const std::vector<PixelPoint> outline{corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1), corner(1, 1)};
    canvas.line(outline, {box.rgb}, 2.0 * scale);
    double top = outline[0].y;
    for (const PixelPoint& point : outline) top = std::min(top, point.y);
    canvas.textOnPlate({view.toPixel(box.x, box.y).x, top - 18.0 * scale}, box.text,
                       {25.0 * scale, {kWhite}, TextAlign::kCentre, true}, {kBackground, 0.8});
  }
}

void drawMarks(Canvas& canvas, const BirdsEyeView& view, const std::vector<Mark>& marks, double scale)
{
  for (const Mark& mark : marks)
  {
    const PixelPoint centre = view.toPixel(mark.x, mark.y);
    const double radius = std::max(mark.radius_m * view.pixelsPerMetre(), 8.0 * scale);
    if (!(std::isfinite(centre.x) && std::isfinite(centre.y) && std::isfinite(radius))) continue;
    canvas.circle(centre, radius, {kBackground, 0.8}, 5.0 * scale);
    canvas.circle(centre, radius, {mark.rgb}, 2.4 * scale);
    TextStyle style{13.0 * scale, {mark.rgb}, TextAlign::kLeft, true};
    const double gap = radius + 8.0 * scale;
    const bool fits = centre.x + gap + canvas.textWidth(mark.text, style) + 6.0 * scale < view.box.right();
    if (!fits) style.align = TextAlign::kRight;
    canvas.textOnPlate({centre.x + (fits ? gap : -gap), centre.y}, mark.text, style, {kBackground, 0.75});
  }
}
}  // namespace

ViewWindow viewWindow(const std::vector<ScanPanel>& panels)
{
  std::vector<float> x, y;
  for (const ScanPanel& panel : panels)
    for (const PanopticPoint& point : *panel.cloud)
      if (point.instance > 0 && isReturn(point)) x.push_back(point.x), y.push_back(point.y);

  ViewWindow window;
  if (x.empty())
  {
    window = {-kEmptyReachM, kEmptyReachM, -0.5 * kEmptyReachM, 0.5 * kEmptyReachM};
    return window;
  }
  std::tie(window.min_x, window.max_x) = middleRange(x);
  std::tie(window.min_y, window.max_y) = middleRange(y);
  window.min_x -= kMarginM, window.max_x += kMarginM;
  window.min_y -= kMarginM, window.max_y += kMarginM;
  widen(window.min_x, window.max_x, std::max(kMinWidthM, window.height() / kMaxAspect));
  widen(window.min_y, window.max_y, kMinAspect * window.width());
  return window;
}

void drawBirdsEyeView(Canvas& canvas, const BirdsEyeView& view, const ScanPanel& panel, double scale)
{
  canvas.clip(view.box);
  canvas.fill(view.box, {kBackground});
  drawRangeCircles(canvas, view, scale);
  drawPoints(canvas, view, *panel.cloud, scale);
  drawRangeLabels(canvas, view, scale);
  drawSensor(canvas, view, scale);
  drawTrails(canvas, view, panel.trails, scale);
  drawBoxes(canvas, view, panel.boxes, scale);
  drawScaleBar(canvas, view, scale);
  drawMarks(canvas, view, panel.marks, scale);
  canvas.unclip();
}
}  // namespace lidar_panoptic_clustering
