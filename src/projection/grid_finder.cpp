#include "lidar_panoptic_clustering/projection/grid_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
/// Above what a sensor's own beam offsets leave after destaggering, below the least an Ouster's staggered cloud has.
constexpr double kMaxStaggeredColumns = 2.5;

/// Recorded PandaSet and Ouster clouds have 1, columns in any order nearly 0.
constexpr double kLeastProgress = 0.5;

/// Halfway between the 370 degrees that drivers put into a scan and the 720 of two. [rad]
constexpr double kMostTurned = 9.42477796076938;

bool canBeReshaped(const RawCloud& raw)
{
  return raw.width > 1 && raw.height > 1 && raw.width != raw.height && raw.row_step == raw.width * raw.point_step;
}

/// A scan line has the finest steps that go along it; steps over several firings may look less staggered by that.
bool isBetter(const Grid& grid, const Grid& than)
{
  constexpr double kFiner = 0.7;
  if (grid.goesAlongLines() != than.goesAlongLines()) return grid.goesAlongLines();
  if (grid.azimuth_step < kFiner * than.azimuth_step) return true;
  if (than.azimuth_step < kFiner * grid.azimuth_step) return false;
  if (grid.isStaggered() != than.isStaggered()) return !grid.isStaggered();
  return grid.elevation_step < 0.9 * than.elevation_step;
}
}  // namespace

RawCloud reshapedView(const RawCloud& raw)
{
  RawCloud view;
  view.width = raw.height, view.height = raw.width;
  view.point_step = raw.point_step, view.row_step = raw.height * raw.point_step;
  view.is_bigendian = raw.is_bigendian;
  view.data = raw.data, view.data_size = raw.data_size;
  return view;
}

std::uint32_t Grid::linesOf(const RawCloud& raw) const
{
  return (orientation == Orientation::kRowsAreRings) != reshaped ? raw.height : raw.width;
}

bool Grid::isStaggered() const
{
  return staggered_columns > kMaxStaggeredColumns;
}

bool Grid::goesOneWay() const
{
  return progress > kLeastProgress;
}

bool Grid::turnsTwice() const
{
  return std::abs(turned) > kMostTurned;
}

const LayoutProbe& GridFinder::look(const RawCloud& raw, const ScanFields& fields)
{
  probe_.look(raw, fields);
  return probe_;
}

std::optional<Grid> GridFinder::findDeclared(const RawCloud& raw, const ScanFields& fields)
{
  probe_.look(raw, fields);
  const auto orientation = probe_.orientation();
  if (!orientation) return std::nullopt;
  return gridAs(*orientation);
}

Grid GridFinder::gridAs(Orientation orientation) const
{
  Grid grid;
  grid.orientation = orientation;
  grid.azimuth_step = probe_.azimuthStep(orientation), grid.elevation_step = probe_.elevationStep(orientation);
  grid.staggered_columns = probe_.staggeredColumns(orientation);
  grid.progress = probe_.progress(orientation), grid.turned = probe_.turned(orientation);
  return grid;
}

std::optional<Grid> GridFinder::find(const RawCloud& raw, const ScanFields& fields)
{
  std::optional<Grid> best = findDeclared(raw, fields);
  if (!canBeReshaped(raw)) return best;
  if (std::optional<Grid> other = findDeclared(reshapedView(raw), fields))
  {
    other->reshaped = true;
    if (!best || isBetter(*other, *best)) best = other;
  }
  probe_.look(best && best->reshaped ? reshapedView(raw) : raw, fields);
  return best;
}

const RingOrder& GridFinder::orderLines(const std::vector<ScanPoint>& points, std::uint32_t width,
                                        Orientation orientation)
{
  const auto columns = std::max(1U, width);
  const std::uint32_t height = static_cast<std::uint32_t>(points.size()) / columns;
  const bool rows_are_rings = orientation == Orientation::kRowsAreRings;
  line_of_point_.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    line_of_point_[i] = {hasDirection(points[i]) ? 0.0F : std::numeric_limits<float>::quiet_NaN(),
                         rows_are_rings ? i / columns : i % columns};
  order_.look(points, line_of_point_, rows_are_rings ? height : columns);
  return order_;
}
}  // namespace lidar_panoptic_clustering
