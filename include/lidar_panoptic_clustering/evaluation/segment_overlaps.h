#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The labels of a scan's points, in one of the two forms they come in. Does not own the arrays.
struct ScanLabels
{
  const std::uint32_t* semantic = nullptr;  ///< raw class ids, or packed labels
  const std::uint32_t* instance = nullptr;  ///< null where labels are packed

  /// SemanticKITTI's form: raw class id in the low 16 bits, instance in the high 16 bits.
  static ScanLabels packed(const std::uint32_t* labels) { return {labels, nullptr}; }
  /// Raw class ids and instances of 32 bits each.
  static ScanLabels separate(const std::uint32_t* class_ids, const std::uint32_t* instances)
  {
    return {class_ids, instances};
  }

  /// Raw class id of point i.
  std::uint32_t classId(std::size_t i) const { return instance == nullptr ? semantic[i] & 0xFFFFU : semantic[i]; }
  /// Instance of point i; 0 for none.
  std::uint32_t instanceId(std::size_t i) const { return instance == nullptr ? semantic[i] >> 16U : instance[i]; }
  /// Class in the high, instance in the low half.
  std::uint64_t key(std::size_t i) const { return std::uint64_t{classId(i)} << 32U | instanceId(i); }
  /// Whether points i and j bear the same label.
  bool sameSegment(std::size_t i, std::size_t j) const
  {
    return semantic[i] == semantic[j] && (instance == nullptr || instance[i] == instance[j]);
  }
};

/// The points of a scan that share raw class id and instance. Two raw ids of one class are two segments, and points
/// without an instance (0) are one segment a raw id, as in the official SemanticKITTI evaluator.
struct Segment
{
  std::uint32_t class_id = 0;              ///< raw
  std::uint32_t instance = 0;              ///< of the label; 0 for none
  ClassIndex class_index = kUnknownClass;  ///< in the class table
  std::uint32_t points = 0;                ///< where the truth is a class that is evaluated
};

/// How many points a predicted and a true segment share; at least one.
struct Overlap
{
  std::uint32_t predicted = 0;  ///< index into SegmentOverlaps::predicted
  std::uint32_t truth = 0;      ///< index into SegmentOverlaps::truth
  std::uint32_t points = 0;     ///< in both
};

/// Dense indices 0, 1, 2 .. for pairs of 64-bit keys in order of first appearance: a hash table with linear probing
/// that is cleared in constant time and allocates only while it grows.
class PairIndex
{
public:
  PairIndex() : slots_(1024) {}
  /// Keeps the memory.
  void clear();
  /// Number of different keys.
  std::uint32_t size() const { return size_; }
  /// The index of (a, b); size() before the call when the pair is new.
  std::uint32_t indexOf(std::uint64_t a, std::uint64_t b);

private:
  struct Slot
  {
    std::uint64_t a = 0, b = 0;
    std::uint32_t index = 0;
    std::uint32_t generation = 0;  ///< the slot is empty unless this is the table's own
  };
  Slot& slotOf(std::uint64_t a, std::uint64_t b);
  void grow();

  std::vector<Slot> slots_;  ///< a power of two, at most half full
  std::uint32_t size_ = 0;
  std::uint32_t generation_ = 1;
};

/// The predicted and the true segments of one scan and the overlaps between them, counted in one pass over the points
/// (runs of equal labels are taken at once). Points whose truth is an ignored or unknown class are left out.
class SegmentOverlaps
{
public:
  /// `table` says which raw ids are which class.
  explicit SegmentOverlaps(std::shared_ptr<const ClassTable> table) : table_(std::move(table)) {}

  /// Replaces what was counted before. Expected linear time; no allocation once the buffers have grown.
  void count(ScanLabels predicted, ScanLabels truth, std::size_t point_count);

  /// Of the scan counted last.
  const std::vector<Segment>& predicted() const { return predicted_; }
  /// Of the scan counted last.
  const std::vector<Segment>& truth() const { return truth_; }
  /// Of the scan counted last; pairs without common points are left out.
  const std::vector<Overlap>& overlaps() const { return overlaps_; }
  /// Of the labels.
  const ClassTable& table() const { return *table_; }

private:
  struct LabelPair
  {
    std::uint64_t predicted = 0, truth = 0;  ///< ScanLabels::key
    std::uint32_t points = 0;                ///< in both
  };
  void countPairs(ScanLabels predicted, ScanLabels truth, std::size_t point_count);

  std::shared_ptr<const ClassTable> table_;
  PairIndex pair_index_, predicted_index_, truth_index_;
  std::vector<LabelPair> pairs_;
  std::vector<Segment> predicted_, truth_;
  std::vector<Overlap> overlaps_;
};

/// Whether a predicted and a true segment of `predicted_points` and `true_points` match: intersection over union above
/// one half. A segment has at most one match among segments that do not overlap each other.
inline bool isMatch(std::uint32_t shared, std::uint32_t predicted_points, std::uint32_t true_points)
{
  return 3 * std::uint64_t{shared} > std::uint64_t{predicted_points} + true_points;
}
}  // namespace lidar_panoptic_clustering
