#include "lidar_panoptic_clustering/projection/organized_rows.h"

#include <algorithm>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Without a branch, which a scattering of missing returns would make costly.
bool isReturn(const ScanPoint& p)
{
  const float zero = p.x * 0.0F + p.y * 0.0F + p.z * 0.0F;  // NaN where one of them is infinite or NaN
  return static_cast<bool>((zero == 0.0F) & ((p.x != 0.0F) | (p.y != 0.0F) | (p.z != 0.0F)));
}

/// Returns whether the lists are those of a frame of rows of the same size: each a point a pixel.
bool resize(const RawCloud& raw, Orientation orientation, OrganizedScan& out)
{
  const std::size_t size = std::size_t{raw.width} * raw.height;
  const bool has_lists = out.organized_input && out.image.begin.size() == size + 1;
  const bool rows_are_rings = orientation == Orientation::kRowsAreRings;
  const std::uint32_t width = out.image.cloud.width;
  out.points.resize(size);
  out.labels.resize(size);
  Projection& image = out.image;
  image.cloud.points.resize(size);
  image.cloud.width = rows_are_rings ? raw.width : raw.height;
  image.cloud.height = rows_are_rings ? raw.height : raw.width;
  image.cloud.is_dense = false;
  image.rings = image.cloud.height;
  image.pixel_of_point.resize(size);
  image.owner_of_pixel.resize(size);
  image.points.resize(size);
  image.begin.resize(size + 1);
  for (std::size_t i = 0; i <= size && !has_lists; ++i) image.begin[i] = static_cast<std::uint32_t>(i);
  return has_lists && image.cloud.width == width;
}

/// What the pixel shows; returns whether that is a return.
bool paintPixel(const ScanPoint& from, std::uint32_t label, LabelledPoint& to)
{
  const bool is_return = isReturn(from);
  to.x = is_return ? from.x : kNaN;
  to.y = is_return ? from.y : kNaN;
  to.z = is_return ? from.z : kNaN;
  to.data[3] = 1.0F;
  to.intensity = from.remission;
  to.label = label;
  return is_return;
}

/// Gives a row of `count` pixels its points, which lie `step` apart as sent; then they are fetched before they are
/// read. `has_lists`: whether rows of as many pixels have lists; then the row's are right when those at its ends are.
void paintRow(OrganizedScan& out, std::size_t pixel, std::size_t point, std::size_t step, std::size_t count,
              bool has_lists)
{
  constexpr std::size_t kAhead = 32;
  Projection& image = out.image;
  std::size_t from = point;
  for (std::size_t i = 0; i < count; ++i, from += step)
  {
    if (step > 1)
    {
      const std::size_t next = std::min(from + kAhead * step, out.points.size() - 1);
      __builtin_prefetch(&out.points[next]);
      __builtin_prefetch(&out.labels[next]);
    }
    const bool is_return = paintPixel(out.points[from], out.labels[from], image.cloud.points[pixel + i]);
    image.owner_of_pixel[pixel + i] = is_return ? static_cast<std::uint32_t>(from) : Projection::kNone;
  }
  const std::size_t last = count - 1;
  if (has_lists && image.points[pixel] == point && image.points[pixel + last] == point + last * step) return;
  for (std::size_t i = 0; i < count; ++i)
  {
    image.points[pixel + i] = static_cast<std::uint32_t>(point + i * step);
    image.pixel_of_point[point + i * step] = static_cast<std::uint32_t>(pixel + i);
  }
}
}  // namespace

void placeRows(const RawCloud& raw, const ScanFields& fields, const RowPlacement& placement, OrganizedScan& out)
{
  const bool has_lists = resize(raw, placement.orientation, out);
  out.organized_input = true;
  const std::size_t width = raw.width, height = raw.height;
  const bool rows_are_rings = placement.orientation == Orientation::kRowsAreRings;
  const auto& row_of_line = placement.row_of_line;
  const auto rowBegin = [&](std::size_t line)
  { return (row_of_line.empty() ? line : row_of_line[line]) * out.image.cloud.width; };

  if (width == 0 || height == 0) return;
  for (std::size_t row = 0; row < height; ++row)
  {
    readScan(raw, fields, row, 0, width, &out.points[row * width], &out.labels[row * width]);
    if (rows_are_rings) paintRow(out, rowBegin(row), row * width, 1, width, has_lists);
  }
  for (std::size_t ring = 0; ring < width && !rows_are_rings; ++ring)
    paintRow(out, rowBegin(ring), ring, width, height, has_lists);
}
}  // namespace lidar_panoptic_clustering
