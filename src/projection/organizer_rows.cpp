// How the Organizer takes clouds that have rows and columns.
#include "lidar_panoptic_clustering/core/one_sweep.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "projection/layout_errors.h"

#include <algorithm>
#include <numeric>

namespace lidar_panoptic_clustering
{
namespace
{
const std::vector<ScanPoint>& readAll(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  placeRows(raw, fields, RowPlacement(), out);
  return out.points;
}

/// Whether the elevation changes faster along a scan line than the azimuth, as it never does along a ring.
bool climbs(const LayoutProbe& probe, Orientation orientation)
{
  constexpr double kClimb = 0.01;  // [rad]
  const double step = probe.elevationStep(orientation);
  return probe.enough() && step > kClimb && step > probe.azimuthStep(orientation);
}
}  // namespace

/// What the cloud's rows and columns are, also where only the parameters or the scans before tell.
Grid Organizer::gridOf(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out, Decision& decision)
{
  Grid grid;
  if (fixed_orientation_)
  {
    const auto found = grid_.findDeclared(raw, fields);
    grid.orientation = *fixed_orientation_;
    if (found && found->orientation == grid.orientation) grid = *found;
    if (found && found->orientation != grid.orientation)
      decision.found.doubt = "the parameter orientation says so, the points say otherwise";
  }
  else if (const auto found = grid_.find(raw, fields))
  {
    grid = *found;
    if (grid.isStaggered() && !grid.goesAlongLines()) throwNoGrid(raw, readAll(raw, fields, out));
  }
  else
  {
    grid.orientation = assumedOrientation(raw);
    if (climbs(grid_.probe(), grid.orientation)) throwNoGrid(raw, readAll(raw, fields, out));
  }
  if (grid.linesOf(raw) > RowFinder::kMaxRings) throwManyLines(grid.linesOf(raw));
  decision.found.orientation = grid.orientation;
  decision.found.reshaped = grid.reshaped;
  decision.firm = false;
  return grid;
}

Organizer::Decision Organizer::decideRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  Decision decision;
  out.layout = decision.found.layout = Layout::kOrganized;
  out.points.clear();
  const Grid grid = gridOf(raw, fields, out, decision);
  const RawCloud view = grid.reshaped ? reshapedView(raw) : raw;
  if (!grid.columnsAreFirings()) refuseColumns(raw, fields, out, grid);
  decision.placement.orientation = grid.orientation;
  placeRows(view, fields, decision.placement, out);
  decision.found.rows = grid.linesOf(raw);
  decision.found.columns = out.image.cloud.width;
  if (decision.found.rows <= 1)
  {
    if (decision.found.rows == 1 && !comesInOneSweep(out.image.cloud)) throwNoScanLines(raw, out.points);
    return decision;
  }
  orderLines(view, out, decision);
  if (!decision.placement.row_of_line.empty()) placeRows(view, fields, decision.placement, out);
  decision.firm = grid_.probe().enough() && grid_.probe().orientation() == grid.orientation;
  return decision;
}

/// Azimuths about the cloud's z mean little where that lies far from the sensor's axis.
void Organizer::refuseColumns(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out, const Grid& grid)
{
  constexpr double kTilted = 0.6;  // [rad]
  const std::uint32_t width = grid.reshaped ? raw.height : raw.width;
  const double tilt = grid_.orderLines(readAll(raw, fields, out), width, grid.orientation).tiltRad();
  if (tilt > kTilted) throwTilted(tilt);
  if (!grid.goesOneWay()) throwNoSequence();
  if (grid.turnsTwice()) throwTurnsTwice(grid.turned);
  throwStaggered(grid.staggered_columns, grid.staggered_columns * grid.azimuth_step);
}

void Organizer::orderLines(const RawCloud& view, OrganizedScan& out, Decision& decision)
{
  FoundLayout& found = decision.found;
  const RingOrder& order = grid_.orderLines(out.points, view.width, found.orientation);
  if (order.tellsNothing() && found.doubt.empty()) throwNoGrid(view, out.points);
  if (order.shareElevations()) throwSharedElevations(view);
  const bool clear = order.areOrdered();
  if (found.reshaped && !clear) throwNoGrid(view, out.points);
  if (clear)
  {
    decision.placement.row_of_line = order.rowOfRing();
  }
  else
  {
    decision.placement.row_of_line.resize(found.rows);
    std::iota(decision.placement.row_of_line.begin(), decision.placement.row_of_line.end(), 0U);
    const auto highest_first = grid_.probe().highestFirst(found.orientation);
    const bool held = decision_.found.known();
    if (order.goesNoWay() || (!highest_first && !held && grid_.probe().enough())) throwUnsorted(view);
    const bool held_lowest_first = held && decision_.found.line_order == LineOrder::kLowestFirst;
    if (!highest_first.value_or(!held_lowest_first))
      std::reverse(decision.placement.row_of_line.begin(), decision.placement.row_of_line.end());
  }
  const auto& rows = decision.placement.row_of_line;
  if (std::is_sorted(rows.rbegin(), rows.rend()))
    found.line_order = LineOrder::kLowestFirst;
  else if (!std::is_sorted(rows.begin(), rows.end()))
    found.line_order = LineOrder::kAsFired;
  if (found.line_order == LineOrder::kHighestFirst) decision.placement.row_of_line.clear();
}

/// Holds a cloud to what the stream's were, by a sample.
void Organizer::followRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  constexpr double kLeastAgreement = 0.4;
  const FoundLayout& found = decision_.found;
  const RawCloud reshaped = found.reshaped ? reshapedView(raw) : RawCloud();
  const RawCloud& view = found.reshaped ? reshaped : raw;
  const auto contradicts = [](const char* what) { throw std::invalid_argument(what); };
  if (found.reshaped && raw.row_step != raw.width * raw.point_step) contradicts("rows are padded");
  const std::uint32_t lines = found.orientation == Orientation::kRowsAreRings ? view.height : view.width;
  if (lines != found.rows) contradicts("another number of rows");

  const LayoutProbe& probe = grid_.look(view, fields);
  if (probe.enough())
  {
    const auto orientation = probe.orientation();
    if (orientation && *orientation != found.orientation && found.doubt.empty()) contradicts("rows and columns");
    if (orientation == found.orientation && !grid_.gridAs(found.orientation).columnsAreFirings())
      contradicts("columns");
    if (!decision_.placement.row_of_line.empty()
            ? probe.agreement(found.orientation, decision_.placement.row_of_line) < kLeastAgreement
            : !probe.highestFirst(found.orientation).value_or(true))
      contradicts("sequence of rows");
    if (!orientation && climbs(probe, found.orientation) && found.doubt.empty()) contradicts("no scan lines");
  }
  placeRows(view, fields, decision_.placement, out);
}

Orientation Organizer::assumedOrientation(const RawCloud& raw) const
{
  if (decision_.found.known() && decision_.found.layout == Layout::kOrganized) return decision_.found.orientation;
  // lidars have fewer rings than firings
  return raw.height <= raw.width ? Orientation::kRowsAreRings : Orientation::kRowsAreFirings;
}
}  // namespace lidar_panoptic_clustering
