#include "lidar_panoptic_clustering/projection/organizer.h"

#include "lidar_panoptic_clustering/core/one_sweep.h"
#include "lidar_panoptic_clustering/core/parameters.h"
#include "projection/layout_errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kFullTurn = 6.28318530717958648;
constexpr std::uint32_t kMinColumns = 16;
constexpr std::size_t kMaxPixels = std::size_t{1} << 22;  // 256 scan lines of 16384 columns

/// Scans in a row that have to contradict what a stream was found to be before it is found to be something else.
constexpr int kPatience = 10;
/// Returns of which a stream can be judged.
constexpr std::size_t kEnoughReturns = 256;

/// Nothing for "auto".
std::optional<Layout> layoutFromName(const std::string& name)
{
  const auto& names = layoutNames();
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Layout>(i - 1);
  return std::nullopt;
}

bool isOneRow(const RawCloud& raw)
{
  return std::min(raw.width, raw.height) == 1 && std::max(raw.width, raw.height) > 1;
}

bool hasSeveralRings(const RawCloud& raw, const ScanFields& fields)
{
  if (fields.ring == nullptr) return false;
  std::uint32_t first = 0, ring = 0;
  for (std::size_t row = 0; row < raw.height; ++row)
    for (std::size_t column = 0; column < raw.width; ++column)
    {
      readIds({raw.point(row, column), 0, 1}, *fields.ring, &ring, 0);
      if (row == 0 && column == 0) first = ring;
      if (ring != first) return true;
    }
  return false;
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

LineOrder sequenceOf(const RingOrder& order)
{
  const auto& row_of_ring = order.rowOfRing();
  if (std::is_sorted(row_of_ring.begin(), row_of_ring.end())) return LineOrder::kHighestFirst;
  return std::is_sorted(row_of_ring.rbegin(), row_of_ring.rend()) ? LineOrder::kLowestFirst : LineOrder::kAsFired;
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
  if (!decision_.firm)
  {
    rows_.forget();
    return adopt(decide(raw, fields, out));
  }
  try
  {
    follow(raw, fields, out);
    against_ = 0;
    return;
  }
  catch (const std::invalid_argument&)
  {
    std::swap(rows_, held_rows_);  // what is known of the stream's rings stays
  }
  reconsider(raw, fields, out);
}

void Organizer::reconsider(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  const bool patient = ++against_ < kPatience;
  rows_.forget();
  Decision fresh;
  try
  {
    fresh = decide(raw, fields, out);
  }
  catch (const std::invalid_argument&)
  {
    if (patient)
      std::swap(rows_, held_rows_);
    else
      decision_.firm = false, against_ = 0;
    throw;
  }
  const std::string expected = describeOrder(decision_.found), found = describeOrder(fresh.found);
  const bool other_size = fresh.firm && fresh.found.layout == Layout::kOrganized && found == expected;
  if (!patient || other_size) return adopt(std::move(fresh));
  std::swap(rows_, held_rows_);
  throw std::invalid_argument("expected " + expected + ", as in the scans before, found " +
                              (found == expected ? describe(fresh.found) : found) +
                              "; the stream is taken for that when " + std::to_string(kPatience) +
                              " scans in a row are so");
}

void Organizer::adopt(Decision decision)
{
  against_ = 0;
  FoundLayout& found = decision.found;
  if (config_.sensor != "auto") found.sensor = config_.sensor;
  const FoundLayout& last = decision_.found;
  found.change = last.change + (!last.known() || describe(found) != describe(last) ? 1 : 0);
  decision_ = std::move(decision);
}

Organizer::Decision Organizer::decide(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  if (!fixed_layout_ && isOneRow(raw)) return decideOneRow(raw, fields, out);
  switch (fixed_layout_.value_or(Layout::kOrganized))
  {
    case Layout::kOrganized:
      return decideRowsOrRings(raw, fields, out);
    case Layout::kRing:
      return decideRings(raw, fields, out);
    case Layout::kBeams:
      return decideBeams(raw, fields, out);
    case Layout::kUnfold:
      if (auto decision = decideUnfolded(raw, fields, out)) return *decision;
      if (out.points.size() < kEnoughReturns) return decideRows(raw, fields, out);
      throwNotUnfolded(out.points, sensor_rows_);
    case Layout::kMerged:
      break;
  }
  return takeInOrder(raw, fields, out);
}

Organizer::Decision Organizer::decideRowsOrRings(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  try
  {
    return decideRows(raw, fields, out);
  }
  catch (const NoGrid&)
  {
    if (fixed_layout_ || !hasSeveralRings(raw, fields)) throw;
  }
  return decideRings(raw, fields, out);
}

Organizer::Decision Organizer::decideOneRow(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  if (hasSeveralRings(raw, fields)) return decideRings(raw, fields, out);
  if (auto decision = decideUnfolded(raw, fields, out)) return *decision;
  return beams_ ? decideBeams(raw, fields, out) : decideRows(raw, fields, out);
}

void Organizer::follow(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  FoundLayout& found = decision_.found;
  out.layout = found.layout;
  if (found.layout == Layout::kOrganized) return followRows(raw, fields, out);
  if (found.layout == Layout::kMerged) return void(takeInOrder(raw, fields, out));

  if (found.layout == Layout::kRing) readRings(raw, fields, found);
  readPoints(raw, fields, out);
  std::uint32_t rows = 0;
  std::optional<Sweep> sweep = found.sweep;
  if (found.layout == Layout::kRing)
    rows = rows_.byRing(out.points, ring_of_point_, found.rings_are_rows ? found.rows : sensor_rows_, found.rows);
  else if (found.layout == Layout::kBeams)
    rows = rows_.byBeam(out.points, *beams_);
  else
    rows = rows_.byUnfolding(out.points, sensor_rows_, found.rows, sweep);
  place(rows, decision_, out);
  if (found.layout == Layout::kUnfold && !rows_.cameRingAfterRing(sensor_rows_) &&
      projector_.returns() >= kEnoughReturns)
    throwNotUnfolded(out.points, sensor_rows_);
  found.sweep = sweep;
  if (rows != found.rows) found.rows = rows, ++found.change;
}

Organizer::Decision Organizer::takeInOrder(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  placeRows(raw, fields, RowPlacement(), out);
  out.layout = Layout::kMerged;
  out.image.cloud.width = static_cast<std::uint32_t>(out.points.size());
  out.image.cloud.height = out.image.rings = 1;
  Decision decision;
  decision.found.layout = Layout::kMerged;
  decision.firm = true;
  return decision;
}

Organizer::Decision Organizer::decideRings(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  Decision decision;
  FoundLayout& found = decision.found;
  found.layout = out.layout = Layout::kRing;
  readPoints(raw, fields, out);
  std::uint32_t lines = sensor_rows_;
  if (fields.ring == nullptr)
  {
    if (isOneRow(raw)) throwNoRing(raw);
    const Grid grid = gridOf(raw, fields, out, decision);
    found.rings_are_rows = true;
    lines = (grid.orientation == Orientation::kRowsAreRings) != grid.reshaped ? raw.height : raw.width;
  }
  readRings(raw, fields, found);
  place(rows_.byRing(out.points, ring_of_point_, lines), decision, out);
  found.line_order = sequenceOf(rows_.order());
  return decision;
}

Organizer::Decision Organizer::decideBeams(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  Decision decision;
  decision.found.layout = out.layout = Layout::kBeams;
  readPoints(raw, fields, out);
  place(rows_.byBeam(out.points, *beams_), decision, out);
  return decision;
}

std::optional<Organizer::Decision> Organizer::decideUnfolded(const RawCloud& raw, const ScanFields& fields,
                                                             OrganizedScan& out)
{
  Decision decision;
  FoundLayout& found = decision.found;
  found.layout = out.layout = Layout::kUnfold;
  readPoints(raw, fields, out);
  found.sweep = Sweep();  // KITTI's
  const std::uint32_t rows = rows_.byUnfolding(out.points, sensor_rows_, 0, found.sweep);
  if (!rows_.cameRingAfterRing(sensor_rows_)) return std::nullopt;
  place(rows, decision, out);
  found.line_order = sequenceOf(rows_.order());
  return decision;
}

void Organizer::place(std::uint32_t rows, Decision& decision, OrganizedScan& out)
{
  FoundLayout& found = decision.found;
  if (!decision.firm)
  {
    decision.firings = rows_.firingsOfTurn();
    found.columns = columns_ > 0 ? std::max(columns_, kMinColumns) : RowFinder::columnsFor(decision.firings);
  }
  if (std::size_t{rows} * found.columns > kMaxPixels)
    throw std::invalid_argument("expected at most " + std::to_string(kMaxPixels) + " pixels, found " +
                                std::to_string(rows) + " rows and " + std::to_string(found.columns) + " columns");
  out.organized_input = false;
  out.image.rings = rows;
  projector_.project(out.points, out.labels, rows_.directions(), rows, found.columns, 0xFFFFFFFFU, out.image,
                     rows_.columnShift(found.columns));
  checkHidden(decision, out);
  if (decision.firm) return;
  found.rows = rows;
  decision.firm = projector_.returns() >= kEnoughReturns && decision.firings > 0.0;
}

/// Two returns of one beam lie in one direction and hide each other by right.
void Organizer::checkHidden(const Decision& decision, const OrganizedScan& out) const
{
  constexpr double kMostHidden = 0.12;    // KITTI's firings, corrected for the car's motion: 0.09
  constexpr float kOneDirection = 2e-3F;  // [rad]
  if (decision.firings <= 0.0 || projector_.returns() < kEnoughReturns) return;
  const double most = std::max(0.0, 1.0 - decision.found.columns / decision.firings) + kMostHidden;
  const auto returns = static_cast<double>(projector_.returns());
  if (static_cast<double>(projector_.hiddenReturns()) <= most * returns) return;
  std::size_t hidden = 0;
  for (const std::uint32_t i : projector_.hidden())
  {
    const std::uint32_t owner = out.image.owner_of_pixel[out.image.pixel_of_point[i]];
    if (!hasDirection(out.points[i]) || owner == Projection::kNone) continue;
    const auto vector = [&out](std::uint32_t k)
    { return Eigen::Vector3f(out.points[k].x, out.points[k].y, out.points[k].z).normalized(); };
    hidden += (vector(i) - vector(owner)).norm() > kOneDirection;
  }
  if (static_cast<double>(hidden) > most * returns) throwHidden(static_cast<double>(hidden) / returns, most);
}

void Organizer::readRings(const RawCloud& raw, const ScanFields& fields, const FoundLayout& found)
{
  ring_of_point_.resize(std::size_t{raw.width} * raw.height);
  if (found.rings_are_rows)
  {
    const std::uint32_t width = found.reshaped ? raw.height : raw.width;
    const bool rows_are_rings = found.orientation == Orientation::kRowsAreRings;
    for (std::uint32_t i = 0; i < ring_of_point_.size(); ++i)
      ring_of_point_[i] = rows_are_rings ? i / width : i % width;
    return;
  }
  if (fields.ring == nullptr) throwNoRing(raw);
  for (std::size_t row = 0; row < raw.height && raw.width > 0; ++row)
    readIds({raw.point(row, 0), raw.point_step, raw.width}, *fields.ring, &ring_of_point_[row * raw.width],
            sizeof(std::uint32_t));
}
}  // namespace lidar_panoptic_clustering
