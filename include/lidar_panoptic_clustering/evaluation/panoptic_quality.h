#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/evaluation/segment_overlaps.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A sum of numbers in (0.5, 1] that does not depend on the order of addition: such a double is a multiple of 2^-53,
/// so the sum is kept as an integer.
struct ExactSum
{
  static constexpr int kFractionBits = 53;  ///< of the fixed point

  std::uint64_t whole = 0;     ///< before the point
  std::uint64_t fraction = 0;  ///< in units of 2^-53, below 2^53

  /// `value`: 0 to 1.
  void add(double value);
  /// The same in any order.
  ExactSum& operator+=(const ExactSum& other);
  /// Rounded once.
  double value() const;
  /// Bit for bit.
  bool operator==(const ExactSum& other) const { return whole == other.whole && fraction == other.fraction; }
};

/// What is counted of one class, and the figures that follow.
struct ClassCounts
{
  std::uint64_t tp = 0, fp = 0, fn = 0;  ///< segments
  ExactSum iou_sum;                      ///< over the true positives
  /// Points, where the truth is evaluated: of this class in both, in the prediction, in the truth.
  std::uint64_t points_both = 0, points_predicted = 0, points_true = 0;

  double sq() const;  ///< segmentation quality: mean IoU of the true positives; 0 without any
  double rq() const;  ///< recognition quality: tp / (tp + fp/2 + fn/2); 0 where the class does not occur
  /// Panoptic quality, 0 to 1.
  double pq() const { return sq() * rq(); }
  double iou() const;  ///< of the points' classes, whatever the instance; 0 where the class does not occur
  /// Whether there was a segment of the class at all.
  bool occurs() const { return tp + fp + fn > 0; }

  /// Of two sets of scans together.
  ClassCounts& operator+=(const ClassCounts& other);
  /// All counts alike.
  bool operator==(const ClassCounts& other) const;
};

/// Means over the classes, absent ones as 0, each in [0, 1].
struct PanopticFigures
{
  double pq = 0.0, rq = 0.0, sq = 0.0;           ///< means over all classes, absent ones as 0
  double pq_dagger = 0.0;                        ///< IoU instead of PQ for stuff [Porzi 2019]
  double pq_th = 0.0, rq_th = 0.0, sq_th = 0.0;  ///< over thing classes
  double pq_st = 0.0, rq_st = 0.0, sq_st = 0.0;  ///< over stuff classes
  double miou = 0.0;                             ///< mean IoU of the classes
  double pq_th_present = 0.0;                    ///< mean PQ of the thing classes with tp + fp + fn > 0
};

/// Panoptic quality [Kirillov 2019] by the rules of SemanticKITTI's official evaluator [Behley 2021], a scan at a time.
///
/// Points whose truth is ignored do not exist; a predicted and a true segment of the same class with an IoU above one
/// half are a true positive, whatever their size; other segments are false only with at least `min_points` points.
/// All that is kept are integer sums: merged parts equal the whole to the bit, in any order.
/// Not shared between threads.
class PanopticQuality
{
public:
  /// Throws std::invalid_argument without a table or with a negative `min_points`.
  explicit PanopticQuality(std::shared_ptr<const ClassTable> table, int min_points = 50);

  /// Raw ids the class table does not name count as ignored. Expected linear time, under 1 ms for a scan of 120,000
  /// points, under 2 ms in random order; no allocation once the buffers have grown.
  void addScan(ScanLabels predicted, ScanLabels truth, std::size_t point_count);
  /// Labels as in the data set's files: class in the low, instance in the high 16 bits.
  void addScan(const std::uint32_t* predicted, const std::uint32_t* truth, std::size_t point_count)
  {
    addScan(ScanLabels::packed(predicted), ScanLabels::packed(truth), point_count);
  }

  /// Adds what another one counted. Throws std::invalid_argument when its classes or min_points are others.
  PanopticQuality& operator+=(const PanopticQuality& other);

  /// By ClassIndex; zero for classes that are not evaluated.
  const std::vector<ClassCounts>& classes() const { return counts_; }
  /// Of all scans added. Linear in the classes.
  PanopticFigures figures() const;
  /// Scans added.
  std::uint64_t scanCount() const { return scan_count_; }
  /// Below which unmatched segments do not count.
  int minPoints() const { return min_points_; }
  /// Of the labels.
  const ClassTable& table() const { return overlaps_.table(); }
  /// The segments of the scan added last.
  const SegmentOverlaps& lastScan() const { return overlaps_; }

  /// Whether both counted the same, under the same rules.
  bool operator==(const PanopticQuality& other) const;

  /// Puts back what was saved: `counts` by ClassIndex. Throws std::invalid_argument when there are not as many as
  /// classes.
  void restore(std::vector<ClassCounts> counts, std::uint64_t scan_count);

  /// Whether a class takes part: things and stuff.
  bool isEvaluated(ClassIndex index) const { return table()[index].kind != ClassKind::kIgnored; }

private:
  void countMatches();
  void countUnmatched(const std::vector<Segment>& segments, const std::vector<bool>& matched,
                      std::uint64_t ClassCounts::*counter);

  int min_points_;
  SegmentOverlaps overlaps_;
  std::vector<bool> predicted_matched_, truth_matched_;
  std::vector<ClassCounts> counts_;
  std::uint64_t scan_count_ = 0;
};
}  // namespace lidar_panoptic_clustering
