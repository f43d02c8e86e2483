#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/evaluation/segment_overlaps.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Each in [0, 1].
struct TemporalFigures
{
  double lstq = 0.0;                 ///< LiDAR segmentation and tracking quality: sqrt(s_assoc * s_cls)
  double s_assoc = 0.0;              ///< mean association over all true tubes; 0 without any
  double s_cls = 0.0;                ///< mean IoU of the points' classes over the classes that occur
  std::vector<double> association;   ///< by ClassIndex: mean over the class's tubes
  std::vector<std::uint64_t> tubes;  ///< by ClassIndex: number of true tubes
};

/// Panoptic quality over time, LSTQ [Aygun et al. 2021, 4D Panoptic LiDAR Segmentation], by the rules of
/// SemanticKITTI's official 4D evaluator.
///
/// Points whose truth is ignored do not exist. A true tube is one instance of one thing class in one sequence; a scan
/// adds its points to it, and to what it shares with predictions, only where there are more than `min_points` of them
/// in that scan. A predicted tube is all points of one instance id in one sequence, whatever their class; id 0 is none.
/// What a true and a predicted tube share does not ask that their classes agree. The association of a true tube is the
/// sum over the predicted ones of TPA * TPA / (|truth| + |predicted| - TPA), divided by |truth|. A class occurs when a
/// point is of it in truth or prediction; ignored classes together are one more, with an IoU of 0, when a point of an
/// evaluated class is predicted to be ignored.
///
/// Counts are whole numbers, so that parts of a sequence can be added in any order. Memory grows with the tubes.
class TemporalQuality
{
public:
  /// Throws std::invalid_argument without a table or with min_points below 0.
  explicit TemporalQuality(std::shared_ptr<const ClassTable> table, int min_points = 50);

  /// Adds a scan that was counted with the same class table. Log-linear in its segments.
  void addScan(const std::string& sequence, const SegmentOverlaps& scan);

  /// Throws std::invalid_argument when min_points or the number of classes differ.
  TemporalQuality& operator+=(const TemporalQuality& other);

  /// Linear in the pairs of tubes that share points; sums go in the order of the tubes' names, so that the same counts
  /// give the same figures to the bit.
  TemporalFigures figures() const;

  std::uint64_t scanCount() const { return scan_count_; }  ///< scans added
  int minPoints() const { return min_points_; }            ///< points that a tube has to have in a scan to count there
  const ClassTable& table() const { return *table_; }      ///< as given

  /// A thing class and its instance; in order of class.
  using TrueTube = std::pair<ClassIndex, std::uint32_t>;
  /// The tubes of a sequence and the points they share.
  struct Sequence
  {
    std::map<TrueTube, std::uint64_t> truth;                             ///< points of each true tube
    std::map<std::uint32_t, std::uint64_t> predicted;                    ///< points of each predicted tube, by id
    std::map<std::pair<TrueTube, std::uint32_t>, std::uint64_t> shared;  ///< points that lie in both
  };
  /// Points of a class in both, in the prediction and in the truth.
  struct ClassPoints
  {
    std::uint64_t both = 0, predicted = 0, truth = 0;  ///< points, by where they have the class
  };
  /// All that is counted; what is ignored stands under kUnknownClass.
  struct Counts
  {
    std::map<std::string, Sequence> sequences;  ///< by name
    std::vector<ClassPoints> classes;           ///< by ClassIndex
    std::uint64_t scans = 0;                    ///< scans added
  };
  Counts counts() const { return {sequences_, classes_, scan_count_}; }  ///< all that was counted so far
  /// Puts back what was saved. Throws std::invalid_argument when there are not as many classes as the table has, or a
  /// tube's class is no thing of it.
  void restore(Counts counts);

private:
  void countClasses(const SegmentOverlaps& scan);

  std::shared_ptr<const ClassTable> table_;
  int min_points_;
  std::map<std::string, Sequence> sequences_;
  std::vector<ClassPoints> classes_;
  std::uint64_t scan_count_ = 0;
};

/// How often a true object's id changes: in scan after scan, the predicted id that covers the most of a true tube's
/// points (id 0 is none; the lower id among equals) against the last one it had before. Scans with at most
/// `min_points` of its points do not count.
class IdSwitches
{
public:
  /// `min_points`: an object with no more points in a scan does not count there.
  explicit IdSwitches(int min_points = 50) : min_points_(min_points) {}

  /// Scans of a sequence come in their order.
  void addScan(const SegmentOverlaps& scan);
  /// Another sequence begins.
  void startSequence() { last_id_.clear(); }
  /// Switches so far, over all sequences.
  std::uint64_t count() const { return count_; }

private:
  int min_points_;
  std::map<TemporalQuality::TrueTube, std::uint32_t> last_id_;
  std::uint64_t count_ = 0;
};
}  // namespace lidar_panoptic_clustering
