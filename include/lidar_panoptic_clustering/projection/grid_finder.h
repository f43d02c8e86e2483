#pragma once

#include "lidar_panoptic_clustering/projection/layout_probe.h"
#include "lidar_panoptic_clustering/projection/ring_order.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The same points with rows and columns exchanged in their number, not in their sequence, as a driver means it that
/// declares rings x firings and lays firing after firing. The view has no fields.
RawCloud reshapedView(const RawCloud& raw);

/// How the points of a cloud of several rows and columns lie.
struct Grid
{
  bool reshaped = false;                                 ///< look at it as reshapedView()
  Orientation orientation = Orientation::kRowsAreRings;  ///< after what `reshaped` says
  double azimuth_step = 0.0, elevation_step = 0.0;       ///< along the scan lines, see LayoutProbe
  double staggered_columns = 0.0;                        ///< see LayoutProbe
  double progress = 1.0, turned = 0.0;                   ///< see LayoutProbe
  /// How many scan lines it has of the cloud as declared.
  std::uint32_t linesOf(const RawCloud& raw) const;
  /// Whether each column is a firing, and all are one scan.
  bool columnsAreFirings() const { return !isStaggered() && goesOneWay() && !turnsTwice(); }
  /// Whether rows are no scan lines of one azimuth a column.
  bool isStaggered() const;
  /// Whether neighbouring columns are neighbours in azimuth.
  bool goesOneWay() const;
  /// Whether the columns are more than one scan. A driver's scan may be some degrees longer than a turn.
  bool turnsTwice() const;
  /// Whether what is taken for a scan line turns more than it climbs.
  bool goesAlongLines() const { return elevation_step < azimuth_step; }
};

/// Finds out what the rows and columns of a cloud are, and in which sequence its scan lines lie.
///
/// Looks at about a thousand returns, at all of them to order the lines. Buffers are kept; not shared between threads.
class GridFinder
{
public:
  /// The grid, of the cloud as declared and of its reshapedView(), that makes the best scan lines: along which the
  /// azimuth changes more than the elevation, in the finest steps; of like ones the one that is not staggered. Empty
  /// where nothing tells. Fields as accepted by findScanFields().
  std::optional<Grid> find(const RawCloud& raw, const ScanFields& fields);

  /// Looks at the cloud as declared, see probe().
  const LayoutProbe& look(const RawCloud& raw, const ScanFields& fields);

  /// What find() finds, of the cloud as declared alone.
  std::optional<Grid> findDeclared(const RawCloud& raw, const ScanFields& fields);

  /// The grid whose orientation is known, by what was looked at last.
  Grid gridAs(Orientation orientation) const;

  /// Of what was looked at last.
  const LayoutProbe& probe() const { return probe_; }

  /// Orders the scan lines of a grid by elevation. `points`: of the whole cloud by row-major index of the view,
  /// `width`: of the view. Linear.
  const RingOrder& orderLines(const std::vector<ScanPoint>& points, std::uint32_t width, Orientation orientation);

private:
  LayoutProbe probe_;
  RingOrder order_;
  std::vector<PointDirection> line_of_point_;
};
}  // namespace lidar_panoptic_clustering
