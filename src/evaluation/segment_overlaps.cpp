#include "lidar_panoptic_clustering/evaluation/segment_overlaps.h"

namespace lidar_panoptic_clustering
{
namespace
{
/// Adds points to the segment of a key; returns its index.
std::uint32_t addPoints(std::uint64_t key, std::uint32_t points, const ClassTable& table, PairIndex& index,
                        std::vector<Segment>& segments)
{
  const std::uint32_t i = index.indexOf(key, 0);
  if (i == segments.size())
  {
    const auto class_id = static_cast<std::uint32_t>(key >> 32U);
    segments.push_back({class_id, static_cast<std::uint32_t>(key), table.find(class_id), 0});
  }
  segments[i].points += points;
  return i;
}
}  // namespace

void PairIndex::clear()
{
  size_ = 0;
  if (++generation_ == 0)  // after 2^32 scans old slots would come back to life
  {
    for (Slot& slot : slots_) slot.generation = 0;
    generation_ = 1;
  }
}

PairIndex::Slot& PairIndex::slotOf(std::uint64_t a, std::uint64_t b)
{
  // labels differ in few bits; a product's high bits depend on all of them
  const std::uint64_t hash = (a * 0x9E3779B97F4A7C15ULL ^ b) * 0xD6E8FEB86659FD93ULL;
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = static_cast<std::size_t>(hash >> 32U) & mask;
  while (slots_[i].generation == generation_ && (slots_[i].a != a || slots_[i].b != b)) i = (i + 1) & mask;
  return slots_[i];
}

std::uint32_t PairIndex::indexOf(std::uint64_t a, std::uint64_t b)
{
  Slot* slot = &slotOf(a, b);
  if (slot->generation == generation_) return slot->index;
  if (2 * (std::size_t{size_} + 1) > slots_.size())
  {
    grow();
    slot = &slotOf(a, b);
  }
  *slot = {a, b, size_, generation_};
  return size_++;
}

void PairIndex::grow()
{
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& slot : old)
    if (slot.generation == generation_) slotOf(slot.a, slot.b) = slot;
}

void SegmentOverlaps::countPairs(ScanLabels predicted, ScanLabels truth, std::size_t point_count)
{
  pair_index_.clear();
  pairs_.clear();
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < point_count; begin = end)
  {
    end = begin + 1;
    while (end < point_count && truth.sameSegment(begin, end) && predicted.sameSegment(begin, end)) ++end;
    const std::uint64_t p = predicted.key(begin), t = truth.key(begin);
    const std::uint32_t pair = pair_index_.indexOf(p, t);
    if (pair == pairs_.size()) pairs_.push_back({p, t, 0});
    pairs_[pair].points += static_cast<std::uint32_t>(end - begin);
  }
}

void SegmentOverlaps::count(ScanLabels predicted, ScanLabels truth, std::size_t point_count)
{
  countPairs(predicted, truth, point_count);
  predicted_index_.clear(), truth_index_.clear();
  predicted_.clear(), truth_.clear(), overlaps_.clear();
  for (const LabelPair& pair : pairs_)
  {
    const ClassIndex true_class = table_->find(static_cast<std::uint32_t>(pair.truth >> 32U));
    if ((*table_)[true_class].kind == ClassKind::kIgnored) continue;
    overlaps_.push_back({addPoints(pair.predicted, pair.points, *table_, predicted_index_, predicted_),
                         addPoints(pair.truth, pair.points, *table_, truth_index_, truth_), pair.points});
  }
}
}  // namespace lidar_panoptic_clustering
