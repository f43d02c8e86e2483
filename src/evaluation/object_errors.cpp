#include "lidar_panoptic_clustering/evaluation/object_errors.h"

#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
/// Whether `part` is more than half of `whole`.
bool isMost(std::uint32_t part, std::uint32_t whole)
{
  return 2 * std::uint64_t{part} > whole;
}
}  // namespace

void ObjectErrorCounts::add(ObjectOutcome outcome)
{
  switch (outcome)
  {
    case ObjectOutcome::kMatched:
      ++matched;
      break;
    case ObjectOutcome::kSplit:
      ++split;
      break;
    case ObjectOutcome::kMerged:
      ++merged;
      break;
    case ObjectOutcome::kMissed:
      ++missed;
      break;
  }
}

ObjectErrorCounts& ObjectErrorCounts::operator+=(const ObjectErrorCounts& other)
{
  matched += other.matched, split += other.split, merged += other.merged, missed += other.missed;
  return *this;
}

bool ObjectErrorCounts::operator==(const ObjectErrorCounts& other) const
{
  return std::tie(matched, split, merged, missed) == std::tie(other.matched, other.split, other.merged, other.missed);
}

bool ObjectErrors::isTrueObject(const SegmentOverlaps& scan, std::uint32_t truth) const
{
  const Segment& segment = scan.truth()[truth];
  return scan.table()[segment.class_index].isThing() && segment.points >= static_cast<std::uint32_t>(min_points_);
}

void ObjectErrors::measure(const SegmentOverlaps& scan)
{
  cover_.assign(scan.truth().size(), {});
  holds_.assign(scan.predicted().size(), {});
  for (const Overlap& overlap : scan.overlaps())
  {
    const Segment& predicted = scan.predicted()[overlap.predicted];
    const Segment& truth = scan.truth()[overlap.truth];
    Cover& cover = cover_[overlap.truth];
    const bool alike = isMatch(overlap.points, predicted.points, truth.points);
    const bool same_class = predicted.class_index == truth.class_index;
    if (alike && same_class) cover.matched = true;

    if (predicted.instance == 0 || !scan.table()[predicted.class_index].isThing()) continue;
    const bool lies_in_it = isMost(overlap.points, predicted.points);
    if (alike && !same_class) cover.matched_but_class = true;
    cover.covered += overlap.points;
    if (lies_in_it)
    {
      cover.piece_points += overlap.points;
      ++cover.pieces;
    }
    if (overlap.points > cover.largest) cover.largest = overlap.points, cover.largest_object = overlap.predicted;

    if (!isTrueObject(scan, overlap.truth) || !(lies_in_it || isMost(overlap.points, truth.points))) continue;
    Holds& holds = holds_[overlap.predicted];
    if (holds.count++ == 0) holds.first = overlap.truth;
  }
}

ObjectOutcome ObjectErrors::outcomeOf(const SegmentOverlaps& scan, std::uint32_t truth) const
{
  const Cover& cover = cover_[truth];
  const std::uint32_t points = scan.truth()[truth].points;
  if (cover.matched) return ObjectOutcome::kMatched;
  if (cover.matched_but_class) return ObjectOutcome::kMissed;
  if (cover.pieces >= 2 && isMost(cover.piece_points, points)) return ObjectOutcome::kSplit;
  if (!isMost(cover.covered, points)) return ObjectOutcome::kMissed;
  const Holds& holds = holds_[cover.largest_object];
  const bool shared = holds.count > 1 || (holds.count == 1 && holds.first != truth);
  return shared ? ObjectOutcome::kMerged : ObjectOutcome::kMissed;
}

const std::vector<TrueObject>& ObjectErrors::judge(const SegmentOverlaps& scan)
{
  measure(scan);
  objects_.clear();
  for (std::uint32_t truth = 0; truth < scan.truth().size(); ++truth)
    if (isTrueObject(scan, truth)) objects_.push_back({scan.truth()[truth], outcomeOf(scan, truth)});
  return objects_;
}
}  // namespace lidar_panoptic_clustering
