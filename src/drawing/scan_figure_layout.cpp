#include "drawing/scan_figure_layout.h"

#include "drawing/range_picture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
void check(const std::vector<ScanPanel>& panels, const ScanFigureOptions& options)
{
  if (panels.empty()) throw std::invalid_argument("scan figure without panels, expected at least one");
  if (options.panel_width_px < 320 || options.panel_width_px > 8192)
    throw std::invalid_argument("scan figure: panel_width_px is " + std::to_string(options.panel_width_px) +
                                ", expected 320..8192");
  if (options.columns < 0)
    throw std::invalid_argument("scan figure: columns is " + std::to_string(options.columns) + ", expected 0 or more");
  if (options.window && !(options.window->width() > 0.0 && options.window->height() > 0.0))
    throw std::invalid_argument("scan figure: expected a window with max above min, in x and in y");
  for (const ScanPanel& panel : panels)
  {
    if (panel.cloud == nullptr) throw std::invalid_argument("scan figure: panel '" + panel.title + "' has no cloud");
    const std::uint64_t expected = std::uint64_t{panel.cloud->width} * panel.cloud->height;
    if (expected != panel.cloud->size())
      throw std::invalid_argument("scan figure: panel '" + panel.title + "' has " +
                                  std::to_string(panel.cloud->size()) + " points, expected width x height = " +
                                  std::to_string(panel.cloud->width) + " x " + std::to_string(panel.cloud->height));
  }
}

int columnCount(const std::vector<ScanPanel>& panels, const ScanFigureOptions& options)
{
  const int count = static_cast<int>(std::min<std::size_t>(panels.size(), 1000));
  const int near_square = count == 3 ? 3 : static_cast<int>(std::ceil(std::sqrt(count)));
  return std::min(count, options.columns > 0 ? options.columns : near_square);
}
}  // namespace

ScanFigureLayout layOut(const std::vector<ScanPanel>& panels, const ScanFigureOptions& options)
{
  check(panels, options);
  ScanFigureLayout layout;
  layout.scale = options.panel_width_px / 1280.0;
  const auto px = [&layout](double size) { return static_cast<int>(std::lround(size * layout.scale)); };
  const ViewWindow window = options.window ? *options.window : viewWindow(panels);
  const int columns = columnCount(panels, options), panel_width = options.panel_width_px;
  const int margin = px(24), title = px(44), gap = px(10), headings = px(24);
  const int view_height = static_cast<int>(std::lround(panel_width * window.height() / window.width()));

  layout.width = margin + columns * (panel_width + margin);
  const bool headed = !options.title.empty() || !options.mark_legend.empty();
  layout.heading = {double(margin), 0.5 * margin, double(layout.width - 2 * margin), headed ? double(px(46)) : 0.0};

  int y = static_cast<int>(layout.heading.bottom());
  for (std::size_t first = 0; first < panels.size(); first += columns)
  {
    int row_height = 0;
    for (std::size_t i = first; i < std::min(panels.size(), first + columns); ++i)
    {
      ScanFigureLayout::Panel panel;
      const double x = margin + static_cast<double>(i - first) * (panel_width + margin), width = panel_width;
      const int range_height = options.range_images ? rangePictureHeight(*panels[i].cloud, panel_width) : 0;
      panel.title = {x, double(y), width, double(title)};
      panel.birds_eye_view = {{x, panel.title.bottom(), width, double(view_height)}, window};
      panel.range_picture = {x, panel.birds_eye_view.box.bottom() + gap, width, double(range_height)};
      row_height = std::max(row_height, title + view_height + (range_height > 0 ? gap + range_height + headings : 0));
      layout.panels.push_back(panel);
    }
    y += row_height + margin;
  }
  layout.height = y;
  return layout;
}
}  // namespace lidar_panoptic_clustering
