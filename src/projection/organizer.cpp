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

/// Scans in a row that have to contradict what a stream was found to be before it is found to be something else.
constexpr int kPatience = 10;

/// Nothing for "auto".
std::optional<Layout> layoutFromName(const std::string& name)
{
  const auto& names = layoutNames();
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Layout>(i - 1);
  return std::nullopt;
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
      return decideUnfoldedOnly(raw, fields, out);
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
  out.layout = decision_.found.layout;
  if (out.layout == Layout::kOrganized) return followRows(raw, fields, out);
  if (out.layout == Layout::kMerged) return void(takeInOrder(raw, fields, out));
  followPoints(raw, fields, out);
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
}  // namespace lidar_panoptic_clustering
