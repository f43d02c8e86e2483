#pragma once

#include "lidar_panoptic_clustering/projection/grid_finder.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Whether a cloud says that it is one row, or one column, of several points.
inline bool isOneRow(const RawCloud& raw)
{
  return std::min(raw.width, raw.height) == 1 && std::max(raw.width, raw.height) > 1;
}

/// What the sequence of a cloud's points looks like, for messages: "firing after firing", "in neighbouring
/// directions" or "in no order of scan lines". Looks at about a thousand pairs.
std::string sequenceOf(const std::vector<ScanPoint>& points);

/// A cloud of rows and columns that are no scan lines.
class NoGrid : public std::invalid_argument
{
public:
  using std::invalid_argument::invalid_argument;
};

/// The following throw std::invalid_argument with what was expected and what was found.
/// `columns`: that the same azimuth is apart in neighbouring scan lines, `angle`: what they span [rad].
[[noreturn]] void throwStaggered(double columns, double angle);
[[noreturn]] void throwNoSequence();
/// `turned`: what the columns span [rad].
[[noreturn]] void throwTurnsTwice(double turned);
[[noreturn]] void throwManyLines(std::uint32_t lines);
[[noreturn]] void throwUnsorted(const RawCloud& raw);
[[noreturn]] void throwUnsortedRings();
[[noreturn]] void throwSharedElevations(const RawCloud& raw);
/// `tilt`: of the sensor's axis against the cloud's z [rad].
[[noreturn]] void throwTilted(double tilt);
/// `points`: of the cloud, as sent.
[[noreturn]] void throwNoScanLines(const RawCloud& raw, const std::vector<ScanPoint>& points);
[[noreturn]] void throwNoRing(const RawCloud& raw);
[[noreturn]] void throwNoGrid(const RawCloud& raw, const std::vector<ScanPoint>& points);
[[noreturn]] void throwNotUnfolded(const std::vector<ScanPoint>& points, std::uint32_t sensor_rows);
/// `share`: of the returns that are hidden, `unavoidable` of it.
[[noreturn]] void throwHidden(double share, double unavoidable);
}  // namespace lidar_panoptic_clustering
