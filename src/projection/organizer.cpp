#include "lidar_panoptic_clustering/projection/organizer.h"

#include "lidar_panoptic_clustering/core/one_sweep.h"
#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/organized_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
/// Above what a sensor's own beam offsets leave after destaggering, below the least an Ouster's staggered cloud has.
constexpr double kMaxStaggeredColumns = 2.5;

constexpr double kFullTurn = 6.28318530717958648;
constexpr std::uint32_t kMinColumns = 16;
constexpr std::size_t kMaxPixels = std::size_t{1} << 22;  // 256 scan lines of 16384 columns

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

[[noreturn]] void throwNoScanLines(const RawCloud& raw)
{
  throw std::invalid_argument(
      "expected an organised cloud (rows and columns), or points with a field 'ring', in the order of rings, or of a "
      "sensor that is named, found one row of " +
      std::to_string(raw.width * std::size_t{raw.height}) + " points with " + describeFields(raw) +
      ": switch on organised output in the driver (velodyne_pointcloud: organize_cloud:=true), set the parameter "
      "sensor, or set layout to 'merged' where the points are several lidars'");
}

[[noreturn]] void throwNoRing(const RawCloud& raw)
{
  throw std::invalid_argument("expected a field 'ring', 'channel' or one named by the parameter ring_field, found " +
                              describeFields(raw));
}

bool isOneRow(const RawCloud& raw)
{
  return std::min(raw.width, raw.height) == 1 && std::max(raw.width, raw.height) > 1;
}

std::uint32_t columnsOfTurn(const SensorModel& sensor)
{
  return static_cast<std::uint32_t>(std::lround(sensor.columns * kFullTurn / sensor.horizontal_fov_rad));
}

void readPoints(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  out.points.resize(std::size_t{raw.width} * raw.height);
  out.labels.resize(out.points.size());
  for (std::size_t row = 0; row < raw.height && raw.width > 0; ++row)
    readScan(raw, fields, row, 0, raw.width, &out.points[row * raw.width], &out.labels[row * raw.width]);
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
      fixed_orientation_(orientationFromName(config.orientation)),
      columns_(static_cast<std::uint32_t>(config.columns))
{
  if (config.sensor != "auto")
  {
    const SensorModel sensor = SensorModel::load(config.sensor);
    sensor_rows_ = sensor.rows();
    beams_.emplace(sensor.elevations_rad);
    if (columns_ == 0) columns_ = columnsOfTurn(sensor);
  }
  if (fixed_layout_ == Layout::kBeams && !beams_)
    throw std::invalid_argument("expected a sensor for the layout 'beams' (parameter sensor), found 'auto'");
}

void Organizer::organize(const RawCloud& raw, OrganizedScan& out)
{
  const ScanFields fields = findScanFields(raw, names_, config_.labels);
  out.layout = layoutOf(raw, fields, out);
  if (out.layout == Layout::kOrganized) return takeRows(raw, fields, out);
  if (out.layout != Layout::kMerged) return placePoints(raw, fields, out);
  placeRows(raw, fields, RowPlacement(), out);
  out.image.cloud.width = static_cast<std::uint32_t>(out.points.size());
  out.image.cloud.height = out.image.rings = 1;
}

Layout Organizer::layoutOf(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  if (fixed_layout_) return *fixed_layout_;
  if (!isOneRow(raw)) return Layout::kOrganized;
  if (fields.ring != nullptr)
  {
    readRings(raw, fields);
    for (const std::uint32_t ring : ring_of_point_)
      if (ring != ring_of_point_[0]) return Layout::kRing;
  }
  readPoints(raw, fields, out);
  if (rows_.canBeUnfolded(out.points, sensor_rows_)) return Layout::kUnfold;
  return beams_ ? Layout::kBeams : Layout::kOrganized;
}

void Organizer::placePoints(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  out.organized_input = false;
  readPoints(raw, fields, out);
  std::uint32_t rows = 0;
  if (out.layout == Layout::kRing)
  {
    readRings(raw, fields);
    rows = rows_.byRing(out.points, ring_of_point_, sensor_rows_);
  }
  else if (out.layout == Layout::kBeams)
    rows = rows_.byBeam(out.points, *beams_);
  else
    rows = rows_.byUnfolding(out.points, sensor_rows_);
  const std::uint32_t columns = columns_ > 0 ? std::max(columns_, kMinColumns) : rows_.columnsOfTurn();
  if (std::size_t{rows} * columns > kMaxPixels)
    throw std::invalid_argument("expected at most " + std::to_string(kMaxPixels) + " pixels, found " +
                                std::to_string(rows) + " rows and " + std::to_string(columns) + " columns");
  out.image.rings = rows;
  projectDirections(out.points, out.labels, rows_.directions(), rows, columns, 0xFFFFFFFFU, out.image);
}

void Organizer::readRings(const RawCloud& raw, const ScanFields& fields)
{
  ring_of_point_.resize(std::size_t{raw.width} * raw.height);
  if (fields.ring != nullptr)
  {
    for (std::size_t row = 0; row < raw.height; ++row)
      readIds({raw.point(row, 0), raw.point_step, raw.width}, *fields.ring, &ring_of_point_[row * raw.width],
              sizeof(std::uint32_t));
    return;
  }
  if (isOneRow(raw)) throwNoRing(raw);
  probe_.look(raw, fields);
  const bool rows_are_rings = orientationOf(raw) == Orientation::kRowsAreRings;
  for (std::uint32_t i = 0; i < ring_of_point_.size(); ++i)
    ring_of_point_[i] = rows_are_rings ? i / raw.width : i % raw.width;
}

void Organizer::takeRows(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  probe_.look(raw, fields);
  RowPlacement placement;
  placement.orientation = orientationOf(raw);
  if (const auto found = probe_.highestFirst(placement.orientation)) last_highest_first_ = found;
  placement.highest_first = last_highest_first_.value_or(true);
  const bool plausible = probe_.orientation().value_or(placement.orientation) == placement.orientation;
  if (plausible && probe_.staggeredColumns(placement.orientation) > kMaxStaggeredColumns)
    throwStaggered(probe_.staggeredColumns(placement.orientation));
  placeRows(raw, fields, placement, out);
  if (out.image.cloud.height == 1 && !comesInOneSweep(out.image.cloud)) throwNoScanLines(raw);
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
