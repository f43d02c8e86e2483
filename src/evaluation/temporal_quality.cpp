#include "lidar_panoptic_clustering/evaluation/temporal_quality.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
using TrueTube = TemporalQuality::TrueTube;

/// Points of a scan's true tubes that have more than min_points, over all raw ids of a class.
std::map<TrueTube, std::uint64_t> tubesOf(const SegmentOverlaps& scan, int min_points)
{
  std::map<TrueTube, std::uint64_t> tubes;
  for (const Segment& segment : scan.truth())
    if (segment.instance != 0 && scan.table()[segment.class_index].isThing())
      tubes[{segment.class_index, segment.instance}] += segment.points;
  for (auto it = tubes.begin(); it != tubes.end();)
    it = it->second > static_cast<std::uint64_t>(min_points) ? std::next(it) : tubes.erase(it);
  return tubes;
}

/// Points that predicted instances share with the tubes.
std::map<std::pair<TrueTube, std::uint32_t>, std::uint64_t> sharedOf(const SegmentOverlaps& scan,
                                                                     const std::map<TrueTube, std::uint64_t>& tubes)
{
  std::map<std::pair<TrueTube, std::uint32_t>, std::uint64_t> shared;
  for (const Overlap& overlap : scan.overlaps())
  {
    const Segment& truth = scan.truth()[overlap.truth];
    const std::uint32_t id = scan.predicted()[overlap.predicted].instance;
    const TrueTube tube{truth.class_index, truth.instance};
    if (id != 0 && tubes.count(tube) != 0) shared[{tube, id}] += overlap.points;
  }
  return shared;
}

double squared(std::uint64_t value)
{
  return static_cast<double>(value) * static_cast<double>(value);
}
}  // namespace

TemporalQuality::TemporalQuality(std::shared_ptr<const ClassTable> table, int min_points)
    : table_(std::move(table)), min_points_(min_points)
{
  if (!table_) throw std::invalid_argument("temporal quality needs a class table");
  if (min_points < 0)
    throw std::invalid_argument("min_points is " + std::to_string(min_points) + ", expected 0 or more");
  classes_.resize(table_->size());
}

void TemporalQuality::addScan(const std::string& sequence, const SegmentOverlaps& scan)
{
  Sequence& tubes = sequences_[sequence];
  const auto truth = tubesOf(scan, min_points_);
  for (const auto& [tube, points] : truth) tubes.truth[tube] += points;
  for (const Segment& segment : scan.predicted())
    if (segment.instance != 0) tubes.predicted[segment.instance] += segment.points;
  for (const auto& [pair, points] : sharedOf(scan, truth)) tubes.shared[pair] += points;
  countClasses(scan);
  ++scan_count_;
}

void TemporalQuality::countClasses(const SegmentOverlaps& scan)
{
  const auto evaluated = [this](ClassIndex c) { return (*table_)[c].kind != ClassKind::kIgnored ? c : kUnknownClass; };
  for (const Overlap& overlap : scan.overlaps())
  {
    const ClassIndex predicted = evaluated(scan.predicted()[overlap.predicted].class_index);
    const ClassIndex truth = scan.truth()[overlap.truth].class_index;
    classes_[predicted].predicted += overlap.points;
    classes_[truth].truth += overlap.points;
    if (predicted == truth) classes_[truth].both += overlap.points;
  }
}

TemporalQuality& TemporalQuality::operator+=(const TemporalQuality& other)
{
  if (min_points_ != other.min_points_ || classes_.size() != other.classes_.size())
    throw std::invalid_argument("temporal qualities with min_points " + std::to_string(min_points_) + " and " +
                                std::to_string(other.min_points_) + ", of " + std::to_string(classes_.size()) +
                                " and " + std::to_string(other.classes_.size()) + " classes, cannot be added");
  for (const auto& [name, tubes] : other.sequences_)
  {
    Sequence& sum = sequences_[name];
    for (const auto& [tube, points] : tubes.truth) sum.truth[tube] += points;
    for (const auto& [id, points] : tubes.predicted) sum.predicted[id] += points;
    for (const auto& [pair, points] : tubes.shared) sum.shared[pair] += points;
  }
  for (std::size_t c = 0; c < classes_.size(); ++c)
  {
    classes_[c].both += other.classes_[c].both;
    classes_[c].predicted += other.classes_[c].predicted;
    classes_[c].truth += other.classes_[c].truth;
  }
  scan_count_ += other.scan_count_;
  return *this;
}

TemporalFigures TemporalQuality::figures() const
{
  TemporalFigures figures;
  figures.association.assign(table_->size(), 0.0);
  figures.tubes.assign(table_->size(), 0);
  std::uint64_t tube_count = 0;
  for (const auto& [name, tubes] : sequences_)
  {
    for (const auto& [tube, points] : tubes.truth) ++figures.tubes[tube.first], ++tube_count;
    for (const auto& [pair, both] : tubes.shared)
    {
      const auto& [tube, id] = pair;
      const std::uint64_t truth = tubes.truth.at(tube), united = truth + tubes.predicted.at(id) - both;
      const double association = squared(both) / static_cast<double>(united) / static_cast<double>(truth);
      figures.association[tube.first] += association;
      figures.s_assoc += association;
    }
  }
  if (tube_count > 0) figures.s_assoc /= static_cast<double>(tube_count);
  for (std::size_t c = 0; c < figures.tubes.size(); ++c)
    if (figures.tubes[c] > 0) figures.association[c] /= static_cast<double>(figures.tubes[c]);

  int occurring = 0;
  for (const ClassPoints& points : classes_)
  {
    const std::uint64_t united = points.predicted + points.truth - points.both;
    if (united == 0) continue;
    figures.s_cls += static_cast<double>(points.both) / static_cast<double>(united);
    ++occurring;
  }
  figures.s_cls /= std::max(occurring, 1);
  figures.lstq = std::sqrt(figures.s_assoc * figures.s_cls);
  return figures;
}

void TemporalQuality::restore(Counts counts)
{
  if (counts.classes.size() != table_->size())
    throw std::invalid_argument("points of " + std::to_string(counts.classes.size()) + " classes, expected " +
                                std::to_string(table_->size()));
  for (const auto& [name, tubes] : counts.sequences)
  {
    for (const auto& [tube, points] : tubes.truth)
      if (tube.first >= table_->size() || !(*table_)[tube.first].isThing() || points == 0)
        throw std::invalid_argument("sequence '" + name + "': a tube of class " + std::to_string(tube.first) + " and " +
                                    std::to_string(points) + " points, expected a thing");
    for (const auto& [pair, points] : tubes.shared)
    {
      const auto truth = tubes.truth.find(pair.first);
      const auto predicted = tubes.predicted.find(pair.second);
      if (truth == tubes.truth.end() || predicted == tubes.predicted.end() || points > truth->second ||
          points > predicted->second)
        throw std::invalid_argument("sequence '" + name + "': tubes share " + std::to_string(points) +
                                    " points, more than they have");
    }
  }
  sequences_ = std::move(counts.sequences);
  classes_ = std::move(counts.classes);
  scan_count_ = counts.scans;
}

void IdSwitches::addScan(const SegmentOverlaps& scan)
{
  const auto tubes = tubesOf(scan, min_points_);
  std::map<TrueTube, std::pair<std::uint64_t, std::uint32_t>> largest;  // points and id
  for (const auto& [pair, points] : sharedOf(scan, tubes))
  {
    auto& [most, id] = largest[pair.first];  // ids come in rising order
    if (points > most) most = points, id = pair.second;
  }
  for (const auto& [tube, cover] : largest)
  {
    const auto [known, is_new] = last_id_.emplace(tube, cover.second);
    if (!is_new && known->second != cover.second) ++count_;
    known->second = cover.second;
  }
}
}  // namespace lidar_panoptic_clustering
