#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/evaluation/segment_overlaps.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What became of a true object where classes do not matter.
enum class RecallOutcome : std::uint8_t
{
  kFound,   ///< a segment has an IoU above one half with it
  kLost,    ///< most of its points are in no segment
  kMerged,  ///< less than half of its best segment is the object
  kSplit,   ///< its best segment is mostly the object, and another segment that is has a tenth of the object or more
  kCut      ///< the rest: too much of it is in no segment
};

/// "found", "lost", ..
const char* nameOf(RecallOutcome outcome);

/// Numbers of true objects; sums, so that parts can be added.
struct RecallCounts
{
  std::uint64_t objects = 0, iou_50 = 0, iou_70 = 0;       ///< with a segment of an IoU above 0.5, 0.7
  std::uint64_t lost = 0, merged = 0, split = 0, cut = 0;  ///< of those without an IoU above 0.5

  RecallCounts& operator+=(const RecallCounts& other);  ///< adds the numbers of another part
  bool operator==(const RecallCounts& other) const;     ///< whether all numbers are equal
};

/// Points by whether they are ground, in the result and in the truth.
struct GroundCounts
{
  std::uint64_t both = 0, found = 0, truth = 0;  ///< in both, in the result, in the truth

  /// Shares, 0 to 1; 0 where there is nothing to share.
  double precision() const { return found == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(found); }
  /// Of the true ground, 0 to 1.
  double recall() const { return truth == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(truth); }
  double iou() const;  ///< 0 to 1; 0 where there is no ground at all
};

/// A true object of one scan.
struct RecalledObject
{
  std::uint32_t class_id = 0, instance = 0;      ///< of the truth
  std::uint32_t points = 0;                      ///< returns
  float range_m = 0.0F;                          ///< horizontal, mean over its points
  double best_iou = 0.0;                         ///< of its best segment, 0 to 1
  RecallOutcome outcome = RecallOutcome::kLost;  ///< what became of it
};

/// A segment that lies mostly on no thing.
struct FalseSegment
{
  std::uint32_t instance = 0;  ///< of the result
  std::uint32_t points = 0;    ///< returns
};

/// A scan's result and truth, by point of the file. Does not own the arrays.
struct RecallScan
{
  const std::uint32_t* found_class = nullptr;     ///< raw ids of the table "object"
  const std::uint32_t* found_instance = nullptr;  ///< 0 for none
  ScanLabels truth;                               ///< of the data set
  const float* range_m = nullptr;                 ///< horizontal
  std::size_t size = 0;                           ///< points, the length of each array
  bool follows = false;                           ///< the scan added before is the one before in time, too
};

/// What counts as an object, and in which bins of range recall is given.
struct ObjectRecallConfig
{
  std::uint32_t min_points = 50;                             ///< of true objects and of false segments
  std::vector<std::uint32_t> no_ground_truth = {0, 1, 70};   ///< raw ids left out of the ground's figures
  std::vector<float> range_ends_m = {10, 20, 30, 50, 1000};  ///< of the bins that recall is given by
};

/// How well objects are found when classes do not matter, as for results without a network.
///
/// - A true object is a thing segment of the truth with an instance and at least `min_points` points; its IoU with a
///   segment counts all points of the file. Each object stands for itself: that two share a segment shows in its IoU.
/// - Its best segment is the one of the highest IoU, the larger share, then the first in the scan among equals.
/// - False is a segment of at least `min_points` points of which more than half are no thing in the truth: stuff, or
///   ignored. Real things without a class (bins, trolleys) are among them: it is a price, not an error as such.
/// - Entropies [Oh et al. 2022, "TRAVEL", section IV.B], natural logarithm, summed over a scan: over-segmentation over
///   true objects, -sum p log p of the shares p of its points in each segment (those in none are one more);
///   under-segmentation over segments of at least `min_points` points, of the shares of each true object in it (all
///   else is one more).
/// - A flip is a true object that two scans in a row show with `min_points` points, and that was found in one of them
///   alone.
/// - Ground is what the table "object" maps the truth's class to.
///
/// Sums alone are kept: parts of a data set can be added. Buffers are kept between scans; not shared between threads.
class ObjectRecall
{
public:
  /// `table`: the truth's. Throws std::invalid_argument without one.
  explicit ObjectRecall(std::shared_ptr<const ClassTable> table, ObjectRecallConfig config = {});

  /// Expected linear time.
  void addScan(const RecallScan& scan);

  /// Throws std::invalid_argument where the configs differ.
  ObjectRecall& operator+=(const ObjectRecall& other);

  const RecallCounts& all() const { return all_; }  ///< over all objects
  /// By name of the truth's class; those that occur.
  const std::map<std::string, RecallCounts>& byClass() const { return by_class_; }
  /// By bin of ObjectRecallConfig::range_ends_m.
  const std::vector<RecallCounts>& byRange() const { return by_range_; }
  const GroundCounts& ground() const { return ground_; }           ///< points of ground
  std::uint64_t scanCount() const { return scan_count_; }          ///< scans added
  std::uint64_t falseSegments() const { return false_segments_; }  ///< over all scans
  /// Pairs of scans in a row that show the same object, and those among them that found it in one scan alone.
  std::uint64_t shownTwice() const { return shown_twice_; }
  std::uint64_t flips() const { return flips_; }  ///< see shownTwice()
  /// In false segments.
  std::uint64_t falsePoints() const { return false_points_; }
  /// Sums over all scans.
  double overSegmentation() const { return over_; }
  double underSegmentation() const { return under_; }           ///< likewise, of segments
  const ObjectRecallConfig& config() const { return config_; }  ///< as given

  /// Of the scan added last, in order of their first point.
  const std::vector<RecalledObject>& objects() const { return objects_; }
  const std::vector<FalseSegment>& lastFalseSegments() const { return last_false_; }  ///< likewise

private:
  struct Pair
  {
    std::uint32_t segment, object;
    std::uint32_t points;
  };
  struct FoundSegment
  {
    std::uint32_t instance = 0, points = 0, no_thing = 0;
    double entropy = 0.0;
  };

  void countPairs(const RecallScan& scan);
  void countGround(const RecallScan& scan);
  void judgeObjects();
  void judgeSegments();
  void countFlips(bool follows);

  ObjectRecallConfig config_;
  std::shared_ptr<const ClassTable> table_;
  std::vector<std::uint8_t> is_ground_;  ///< by class index of the truth
  std::uint32_t ground_id_ = 0;

  RecallCounts all_;
  std::map<std::string, RecallCounts> by_class_;
  std::vector<RecallCounts> by_range_;
  GroundCounts ground_;
  std::uint64_t scan_count_ = 0, false_segments_ = 0, false_points_ = 0;
  std::uint64_t shown_twice_ = 0, flips_ = 0;
  double over_ = 0.0, under_ = 0.0;

  // of the last scan; segment 0 stands for points in none, object 0 for all that is no true thing with an instance
  PairIndex pair_index_, segment_index_, object_index_;
  std::vector<Pair> pairs_;
  std::vector<FoundSegment> segments_;
  std::vector<RecalledObject> all_objects_, objects_;
  std::vector<double> range_sum_;
  std::vector<FalseSegment> last_false_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> was_found_;  ///< by class and instance
};

/// The tables a person reads.
std::string formatObjectRecall(const ObjectRecall& recall);
}  // namespace lidar_panoptic_clustering
