// How the Organizer takes clouds whose points it places one by one: by ring, by beam, or ring after ring.
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "projection/layout_errors.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kMinColumns = 16;
constexpr std::size_t kMaxPixels = std::size_t{1} << 22;  // 256 scan lines of 16384 columns

/// Returns of which a stream can be judged.
constexpr std::size_t kEnoughReturns = 256;

/// Rings that come one after another are told apart by the azimuth at which they begin, which a tilted frame spreads:
/// at this angle a hundredth of the returns are in the row beside their own, and columns hide two. [rad]
constexpr double kMostTilt = 0.22;

/// The points and, where `ring_of_point` is asked for, their field `ring`: both of a piece while it is in the cache.
void readPoints(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out,
                std::vector<std::uint32_t>* ring_of_point = nullptr)
{
  constexpr std::size_t kPiece = 512;
  const std::size_t width = raw.width;
  out.points.resize(width * raw.height);
  out.labels.resize(out.points.size());
  if (ring_of_point != nullptr) ring_of_point->resize(out.points.size());
  for (std::size_t row = 0; row < raw.height; ++row)
    for (std::size_t begin = 0; begin < width; begin += kPiece)
    {
      const std::size_t count = std::min(kPiece, width - begin), first = row * width + begin;
      readScan(raw, fields, row, begin, count, &out.points[first], &out.labels[first]);
      if (ring_of_point == nullptr) continue;
      readIds({raw.point(row, begin), raw.point_step, count}, *fields.ring, &(*ring_of_point)[first],
              sizeof(std::uint32_t));
    }
}

LineOrder sequenceOf(const RingOrder& order)
{
  const auto& row_of_ring = order.rowOfRing();
  if (std::is_sorted(row_of_ring.begin(), row_of_ring.end())) return LineOrder::kHighestFirst;
  return std::is_sorted(row_of_ring.rbegin(), row_of_ring.rend()) ? LineOrder::kLowestFirst : LineOrder::kAsFired;
}
}  // namespace

void Organizer::followPoints(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  FoundLayout& found = decision_.found;
  if (found.layout == Layout::kRing)
    readRings(raw, fields, found, out);
  else
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

Organizer::Decision Organizer::decideRings(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  Decision decision;
  FoundLayout& found = decision.found;
  found.layout = out.layout = Layout::kRing;
  std::uint32_t lines = sensor_rows_;
  if (fields.ring == nullptr)
  {
    if (isOneRow(raw)) throwNoRing(raw);
    readPoints(raw, fields, out);
    const Grid grid = gridOf(raw, fields, out, decision);
    found.rings_are_rows = true;
    lines = grid.linesOf(raw);
    numberRings(raw, found);
  }
  else
  {
    readRings(raw, fields, found, out);
  }
  const std::uint32_t rows = rows_.byRing(out.points, ring_of_point_, lines);
  if (!rows_.order().areOrdered() && rows_.order().goesNoWay()) throwUnsortedRings();
  place(rows, decision, out);
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

Organizer::Decision Organizer::decideUnfoldedOnly(const RawCloud& raw, const ScanFields& fields, OrganizedScan& out)
{
  if (auto decision = decideUnfolded(raw, fields, out)) return *decision;
  if (out.points.size() < kEnoughReturns) return decideRows(raw, fields, out);
  throwNotUnfolded(out.points, sensor_rows_);
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
  if (const auto tilt = rows_.order().tiltOfAxis(); tilt > kMostTilt) throwTilted(*tilt);
  place(rows, decision, out);
  found.line_order = sequenceOf(rows_.order());
  return decision;
}

void Organizer::place(std::uint32_t rows, Decision& decision, OrganizedScan& out)
{
  constexpr double kEven = 0.06;  // of returns hidden in columns that fit the firings
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
  project(rows, found.columns, out);
  const double most = mostHidden(decision);
  double hidden = hiddenShare(most, out);
  if (hidden > most && !decision.firm && columns_ == 0)
  {
    // few returns, or azimuths that vary, look like fewer firings
    found.columns *= 2;
    project(rows, found.columns, out);
    if (hiddenShare(kEven, out) <= kEven) hidden = 0.0;
  }
  if (hidden > most) throwHidden(hidden, most);
  if (decision.firm) return;
  found.rows = rows;
  decision.firm = projector_.returns() >= kEnoughReturns && decision.firings > 0.0;
}

void Organizer::project(std::uint32_t rows, std::uint32_t columns, OrganizedScan& out)
{
  projector_.project(out.points, out.labels, rows_.directions(), rows, columns, 0xFFFFFFFFU, out.image,
                     rows_.columnShift(columns));
}

/// The share of returns that a scan hides: what more firings than columns make unavoidable, and what their unevenness
/// does; in KITTI's scans, corrected for the car's motion, that is 0.09. 1 where the firings are not known.
double Organizer::mostHidden(const Decision& decision) const
{
  constexpr double kUneven = 0.12;
  if (decision.firings <= 0.0 || projector_.returns() < kEnoughReturns) return 1.0;
  return std::max(0.0, 1.0 - decision.found.columns / decision.firings) + kUneven;
}

/// The share of returns that their pixel does not show. Where it is more than `most`, second returns of one beam do not
/// count: they lie in one direction and hide each other by right.
double Organizer::hiddenShare(double most, const OrganizedScan& out) const
{
  constexpr float kOneDirection = 2e-3F;  // [rad]
  const auto returns = static_cast<double>(std::max<std::size_t>(1, projector_.returns()));
  const double share = static_cast<double>(projector_.hiddenReturns()) / returns;
  if (share <= most) return share;
  std::size_t hidden = 0;
  for (const std::uint32_t i : projector_.hidden())
  {
    const std::uint32_t owner = out.image.owner_of_pixel[out.image.pixel_of_point[i]];
    if (!hasDirection(out.points[i]) || owner == Projection::kNone) continue;
    const auto vector = [&out](std::uint32_t k)
    { return Eigen::Vector3f(out.points[k].x, out.points[k].y, out.points[k].z).normalized(); };
    hidden += (vector(i) - vector(owner)).norm() > kOneDirection;
  }
  return static_cast<double>(hidden) / returns;
}

/// The points and the ring of each.
void Organizer::readRings(const RawCloud& raw, const ScanFields& fields, const FoundLayout& found, OrganizedScan& out)
{
  if (!found.rings_are_rows && fields.ring == nullptr) throwNoRing(raw);
  readPoints(raw, fields, out, found.rings_are_rows ? nullptr : &ring_of_point_);
  if (found.rings_are_rows) numberRings(raw, found);
}

/// The ring of each point where the cloud's rows or columns are the rings.
void Organizer::numberRings(const RawCloud& raw, const FoundLayout& found)
{
  ring_of_point_.resize(std::size_t{raw.width} * raw.height);
  const std::uint32_t width = found.reshaped ? raw.height : raw.width;
  const bool rows_are_rings = found.orientation == Orientation::kRowsAreRings;
  for (std::uint32_t i = 0; i < ring_of_point_.size(); ++i) ring_of_point_[i] = rows_are_rings ? i / width : i % width;
}
}  // namespace lidar_panoptic_clustering
