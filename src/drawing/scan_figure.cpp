#include "lidar_panoptic_clustering/drawing/scan_figure.h"

#include "drawing/range_picture.h"
#include "drawing/round_numbers.h"
#include "drawing/scan_figure_layout.h"

#include <algorithm>
#include <unordered_set>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kPaper = 0x161B22, kTitle = 0xF2F5F8, kCaption = 0x9DA9B8, kFrame = 0x303844;

std::string count(std::size_t number, const std::string& noun)
{
  return roundNumber(static_cast<double>(number), 0) + " " + noun + (number == 1 ? "" : "s");
}

/// "103,218 returns, 9,871 on things, 31 instances"
std::string describe(const ScanPanel& panel, bool counted)
{
  if (!counted) return panel.caption;
  std::size_t returns = 0, things = 0;
  std::unordered_set<std::uint32_t> instances;
  for (const PanopticPoint& point : *panel.cloud)
  {
    if (!isReturn(point)) continue;
    ++returns;
    if (point.instance == 0) continue;
    ++things;
    instances.insert(point.instance);
  }
  const std::string counts = count(returns, "return") + ", " + roundNumber(static_cast<double>(things), 0) +
                             " on things, " + count(instances.size(), "instance");
  return panel.caption.empty() ? counts : counts + ", " + panel.caption;
}

void drawHeading(Canvas& canvas, const ScanFigureLayout& layout, const ScanFigureOptions& options)
{
  const double middle = layout.heading.y + 0.5 * layout.heading.height;
  const TextStyle style{15.0 * layout.scale, {kCaption}};
  double right = layout.heading.right();
  for (auto it = options.mark_legend.rbegin(); it != options.mark_legend.rend(); ++it)
  {
    right -= canvas.textWidth(it->text, style);
    canvas.text({right, middle}, it->text, style);
    right -= 16.0 * layout.scale;
    canvas.circle({right, middle}, 7.0 * layout.scale, {it->rgb}, 2.4 * layout.scale);
    right -= 30.0 * layout.scale;
  }
  canvas.fittedText({layout.heading.x, middle}, options.title, {24.0 * layout.scale, {kTitle}, TextAlign::kLeft, true},
                    right - layout.heading.x);
}

void drawTitle(Canvas& canvas, const Box& box, const ScanPanel& panel, bool counted, double scale)
{
  const double middle = box.y + 0.5 * box.height;
  const TextStyle style{19.0 * scale, {kTitle}, TextAlign::kLeft, true};
  canvas.fittedText({box.x, middle}, panel.title, style, 0.6 * box.width);
  const double used = std::min(0.6 * box.width, canvas.textWidth(panel.title, style)) + 24.0 * scale;
  canvas.fittedText({box.right(), middle}, describe(panel, counted), {15.0 * scale, {kCaption}, TextAlign::kRight},
                    box.width - used);
}

void drawFrame(Canvas& canvas, const Box& box)
{
  const double left = box.x - 0.5, top = box.y - 0.5, right = box.right() + 0.5, bottom = box.bottom() + 0.5;
  canvas.line({{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}, {kFrame}, 1.0);
}
}  // namespace

void drawScanFigure(const std::vector<ScanPanel>& panels, const std::string& png_path, const ScanFigureOptions& options)
{
  const ScanFigureLayout layout = layOut(panels, options);
  Canvas canvas(layout.width, layout.height, kPaper);
  if (layout.heading.height > 0.0) drawHeading(canvas, layout, options);
  for (std::size_t i = 0; i < panels.size(); ++i)
  {
    const ScanFigureLayout::Panel& place = layout.panels[i];
    drawTitle(canvas, place.title, panels[i], options.counts, layout.scale);
    drawBirdsEyeView(canvas, place.birds_eye_view, panels[i], layout.scale);
    drawFrame(canvas, place.birds_eye_view.box);
    if (place.range_picture.height <= 0.0) continue;
    drawRangePicture(canvas, place.range_picture, *panels[i].cloud);
    drawFrame(canvas, place.range_picture);
    drawHeadings(canvas, place.range_picture, *panels[i].cloud, layout.scale);
  }
  canvas.writePng(png_path);
}
}  // namespace lidar_panoptic_clustering
