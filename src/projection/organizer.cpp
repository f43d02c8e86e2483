#include "lidar_panoptic_clustering/projection/organizer.h"

#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/organized_rows.h"

#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
/// Above what a sensor's own beam offsets leave after destaggering, below the least an Ouster's staggered cloud has.
constexpr double kMaxStaggeredColumns = 2.5;

/// Nothing for "auto".
std::optional<Layout> layoutFromName(const std::string& name)
{
  const auto& names = layoutNames();
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Layout>(i - 1);
  return std::nullopt;
}

[[noreturn]] void throwStaggered(double columns)
{
  throw std::invalid_argument(
      "expected columns of one azimuth, found neighbouring scan lines " + std::to_string(std::lround(columns)) +
      " columns apart in the mean: switch on destaggering in the driver (ouster_ros: destagger:=true), or set the "
      "parameter layout to 'ring', which places the points by their azimuth");
}

const OrganizerConfig& validated(const OrganizerConfig& config)
{
  validateParameters(config);
  return config;
}
}  // namespace

const std::vector<std::string>& layoutNames()
{
  static const std::vector<std::string> names = {"auto", "organized", "ring", "beams", "unfold", "merged"};
  return names;
}

Organizer::Organizer(const OrganizerConfig& config)
    : config_(validated(config)),
      names_{config.label_field, config.intensity_field, config.ring_field},
      fixed_layout_(layoutFromName(config.layout)),
      fixed_orientation_(orientationFromName(config.orientation))
{
}

void Organizer::organize(const RawCloud& raw, OrganizedScan& out)
{
  const ScanFields fields = findScanFields(raw, names_, config_.labels);
  out.layout = layoutOf(raw, fields);
  takeRows(raw, fields, out);
}

Layout Organizer::layoutOf(const RawCloud& raw, const ScanFields&) const
{
  if (fixed_layout_) return *fixed_layout_;
  if (raw.height == 1 && raw.width > 1)
    throw std::invalid_argument("expected an organised cloud (rows and columns), found one row of " +
                                std::to_string(raw.width) +
                                " points: switch on organised output in the driver "
                                "(velodyne_pointcloud: organize_cloud:=true)");
  return Layout::kOrganized;
}

void Organizer::takeRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  probe_.look(raw, fields);
  RowPlacement placement;
  placement.orientation = orientationOf(raw);
  if (const auto found = probe_.highestFirst(placement.orientation)) last_highest_first_ = found;
  placement.highest_first = last_highest_first_.value_or(true);
  if (probe_.staggeredColumns(placement.orientation) > kMaxStaggeredColumns)
    throwStaggered(probe_.staggeredColumns(placement.orientation));
  placeRows(raw, fields, placement, out);
}

Orientation Organizer::orientationOf(const RawCloud& raw)
{
  if (fixed_orientation_) return *fixed_orientation_;
  if (const auto found = probe_.orientation()) last_orientation_ = found;
  if (last_orientation_) return *last_orientation_;
  // lidars have fewer rings than firings
  return raw.height <= raw.width ? Orientation::kRowsAreRings : Orientation::kRowsAreFirings;
}
}  // namespace lidar_panoptic_clustering
