#pragma once

#include "lidar_panoptic_clustering/evaluation/segment_overlaps.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What became of a true object.
enum class ObjectOutcome : std::uint8_t
{
  kMatched,  ///< a true positive: a predicted segment of its class with an IoU above one half
  kSplit,    ///< its points are spread over several predicted objects
  kMerged,   ///< it shares a predicted object with another true object
  kMissed    ///< the rest: no instance, another class, or more of the surroundings than of the object
};

/// A thing segment of the truth with at least min_points points.
struct TrueObject
{
  Segment segment;                                 ///< the true one
  ObjectOutcome outcome = ObjectOutcome::kMissed;  ///< what became of it
};

/// Numbers of true objects by outcome; sums, so that parts can be added.
struct ObjectErrorCounts
{
  std::uint64_t matched = 0, split = 0, merged = 0, missed = 0;  ///< true objects with this outcome

  /// All true objects.
  std::uint64_t total() const { return matched + split + merged + missed; }
  /// Counts one object.
  void add(ObjectOutcome outcome);
  /// Of two sets of scans together.
  ObjectErrorCounts& operator+=(const ObjectErrorCounts& other);
  /// All four alike.
  bool operator==(const ObjectErrorCounts& other) const;
};

/// Says of every true object whether it was matched, split, merged or missed.
///
/// A predicted object is a predicted thing segment with an instance (not 0), whatever its thing class. Of the true
/// objects without a match, one is
/// - missed (by its class) when a predicted object of another thing class has an IoU above one half with it; else
/// - split when two or more predicted objects that lie for more than half of their points in it together cover more
/// than
///   half of it; else
/// - merged when predicted objects together cover more than half of it, and the one that covers the most of it (the
///   first in the scan among equals) also covers more than half of another true object, or lies for more than half of
///   its points in another; else
/// - missed.
/// Split, merged and missed together are the false negatives of the thing classes. Buffers are kept between scans.
class ObjectErrors
{
public:
  /// True objects of fewer points than `min_points` are not judged.
  explicit ObjectErrors(int min_points = 50) : min_points_(min_points) {}

  /// The true objects of a scan, in order of their first point; valid until the next call. Linear in the overlaps.
  const std::vector<TrueObject>& judge(const SegmentOverlaps& scan);

private:
  /// What predicted objects make of one true segment [points].
  struct Cover
  {
    std::uint32_t covered = 0;       ///< in predicted objects
    std::uint32_t piece_points = 0;  ///< in predicted objects that lie mostly in it
    std::uint32_t pieces = 0;        ///< the number of those
    std::uint32_t largest = 0;       ///< in the predicted object that covers the most of it
    std::uint32_t largest_object = 0;
    bool matched = false;
    bool matched_but_class = false;  ///< a predicted object of another class has an IoU above one half
  };
  /// The true objects a predicted object covers mostly or lies mostly in.
  struct Holds
  {
    std::uint32_t count = 0;
    std::uint32_t first = 0;
  };
  bool isTrueObject(const SegmentOverlaps& scan, std::uint32_t truth) const;
  void measure(const SegmentOverlaps& scan);
  ObjectOutcome outcomeOf(const SegmentOverlaps& scan, std::uint32_t truth) const;

  int min_points_;
  std::vector<Cover> cover_;  ///< by true segment
  std::vector<Holds> holds_;  ///< by predicted segment
  std::vector<TrueObject> objects_;
};
}  // namespace lidar_panoptic_clustering
