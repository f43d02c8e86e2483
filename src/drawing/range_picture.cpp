#include "drawing/range_picture.h"

#include "drawing/birds_eye_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNoReturn = 0x05070A, kText = 0x8A97A8;
constexpr double kPi = 3.14159265358979323846;

float range(const PanopticPoint& point)
{
  return std::sqrt(point.x * point.x + point.y * point.y + point.z * point.z);
}

std::uint32_t greyByRange(float metres)
{
  const auto grey = static_cast<std::uint32_t>(std::lround(32.0 + 84.0 * std::exp(-metres / 25.0)));
  return grey << 16 | grey << 8 | grey;
}

/// Whether the first rows look higher than the last: drivers number the rings either way.
bool highestBeamFirst(const PanopticCloud& cloud)
{
  double upper = 0.0, lower = 0.0;
  std::size_t upper_count = 0, lower_count = 0;
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < cloud.width; ++column)
    {
      const PanopticPoint& point = cloud.points[std::size_t{row} * cloud.width + column];
      if (!isReturn(point)) continue;
      const double elevation = std::atan2(point.z, std::hypot(point.x, point.y));
      if (2 * row < cloud.height)
        upper += elevation, ++upper_count;
      else
        lower += elevation, ++lower_count;
    }
  if (upper_count == 0 || lower_count == 0) return true;
  return upper / static_cast<double>(upper_count) >= lower / static_cast<double>(lower_count);
}

/// The part [first, last) of `count` cells that picture cell `index` of `cells` shows: at least one.
struct Span
{
  std::uint32_t first, last;
};
Span span(std::uint32_t index, std::uint32_t cells, std::uint32_t count)
{
  const auto first = static_cast<std::uint32_t>(std::uint64_t{index} * count / cells);
  const auto last = static_cast<std::uint32_t>(std::uint64_t{index + 1} * count / cells);
  return {first, std::max(last, first + 1)};
}

/// The nearest return on an object, else the nearest return, else none.
std::uint32_t colorOf(const PanopticCloud& cloud, Span rows, Span columns)
{
  const PanopticPoint* shown = nullptr;
  float shown_range = std::numeric_limits<float>::infinity();
  for (std::uint32_t row = rows.first; row < rows.last; ++row)
    for (std::uint32_t column = columns.first; column < columns.last; ++column)
    {
      const PanopticPoint& point = cloud.points[std::size_t{row} * cloud.width + column];
      if (!isReturn(point)) continue;
      const bool thing = point.instance > 0, shown_thing = shown != nullptr && shown->instance > 0;
      const float point_range = range(point);
      if (shown != nullptr && (thing == shown_thing ? point_range >= shown_range : shown_thing)) continue;
      shown = &point, shown_range = point_range;
    }
  if (shown == nullptr) return kNoReturn;
  return shown->instance > 0 ? shown->rgb : greyByRange(shown_range);
}
}  // namespace

int rangePictureHeight(const PanopticCloud& cloud, int width_px)
{
  if (cloud.height < 2 || cloud.width == 0) return 0;
  const int room = width_px / 5, rows = static_cast<int>(std::min(cloud.height, 65536U));
  return rows <= room ? rows * std::min(room / rows, std::max(4, room / 48)) : room;
}

void drawRangePicture(Canvas& canvas, const Box& box, const PanopticCloud& cloud)
{
  const auto left = static_cast<int>(box.x), top = static_cast<int>(box.y);
  const auto width = static_cast<std::uint32_t>(box.width), height = static_cast<std::uint32_t>(box.height);
  const bool upright = highestBeamFirst(cloud);

  std::vector<Dot> dots;
  dots.reserve(std::size_t{width} * height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
    {
      const Span rows = span(upright ? y : height - 1 - y, height, cloud.height);
      const std::uint32_t rgb = colorOf(cloud, rows, span(x, width, cloud.width));
      dots.push_back({left + static_cast<int>(x), top + static_cast<int>(y), 1, rgb});
    }
  canvas.dots(dots, box);
}

void drawHeadings(Canvas& canvas, const Box& box, const PanopticCloud& cloud, double scale)
{
  struct Heading
  {
    const char* name;
    double azimuth;
    double nearest = 3.0 * kPi / 180.0;  ///< a sector may not see this heading at all
    std::uint32_t column = 0;
    bool seen = false;
  };
  std::array<Heading, 4> headings{{{"front", 0.0}, {"left", 0.5 * kPi}, {"back", kPi}, {"right", -0.5 * kPi}}};
  for (std::uint32_t column = 0; column < cloud.width; ++column)
    for (std::uint32_t row = 0; row < cloud.height; ++row)
    {
      const PanopticPoint& point = cloud.points[std::size_t{row} * cloud.width + column];
      if (!isReturn(point)) continue;
      for (Heading& heading : headings)
      {
        const double off = std::abs(std::remainder(std::atan2(point.y, point.x) - heading.azimuth, 2.0 * kPi));
        if (off < heading.nearest) heading.nearest = off, heading.column = column, heading.seen = true;
      }
      break;  // all beams of a firing look the same way
    }

  TextStyle style{13.0 * scale, {kText}};
  for (const Heading& heading : headings)
  {
    if (!heading.seen) continue;
    const double x = box.x + (heading.column + 0.5) / cloud.width * box.width;
    const double half = 0.5 * canvas.textWidth(heading.name, style);
    style.align = x - half < box.x ? TextAlign::kLeft : x + half > box.right() ? TextAlign::kRight : TextAlign::kCentre;
    canvas.line({{x, box.bottom() + 1.0}, {x, box.bottom() + 5.0 * scale}}, {kText}, 1.5 * scale);
    canvas.text({x, box.bottom() + 13.0 * scale}, heading.name, style);
  }
}
}  // namespace lidar_panoptic_clustering
