#pragma once

#include "lidar_panoptic_clustering/projection/layout_probe.h"
#include "lidar_panoptic_clustering/projection/organized_scan.h"
#include "lidar_panoptic_clustering/projection/scan_unfolding.h"

#include <cstdint>
#include <optional>
#include <string>

namespace lidar_panoptic_clustering
{
/// In which sequence a driver's scan lines or rings lie.
enum class LineOrder
{
  kHighestFirst,
  kLowestFirst,
  kAsFired  ///< channels in any sequence; sorted by their elevation
};

/// What an Organizer found a stream of clouds to be.
struct FoundLayout
{
  Layout layout = Layout::kOrganized;
  Orientation orientation = Orientation::kRowsAreRings;  ///< of organised clouds, after what `reshaped` says
  bool reshaped = false;        ///< declared as rows x columns, the points laid as columns x rows
  bool rings_are_rows = false;  ///< layout ring without a field for it: the verified rows of the cloud are the rings
  LineOrder line_order = LineOrder::kHighestFirst;
  std::optional<Sweep> sweep;           ///< of points that come ring after ring
  std::uint32_t rows = 0, columns = 0;  ///< of the image; columns of an organised cloud may differ from scan to scan
  std::string sensor;                   ///< the parameter sensor; empty where none is named
  std::string doubt;                    ///< what a parameter sets that the points contradict; empty for none
  std::uint32_t change = 0;  ///< grows by 1 whenever the description becomes another; 0 before the first cloud

  bool known() const { return change > 0; }
};

/// For logs and diagnostics, one line: "rows are rings, the highest first: 64 rows; no sensor file". The same text for
/// all scans of a stream that does not change.
std::string describe(const FoundLayout& found);

/// "rows are rings, the highest first": what describe() begins with.
std::string describeOrder(const FoundLayout& found);
}  // namespace lidar_panoptic_clustering
