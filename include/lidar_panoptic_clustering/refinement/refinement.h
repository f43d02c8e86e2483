#pragma once

#include "lidar_panoptic_clustering/core/instances.h"
#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/refinement/box_splitting.h"
#include "lidar_panoptic_clustering/refinement/class_bridging.h"
#include "lidar_panoptic_clustering/refinement/part_merging.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Which steps are taken, and their limits.
struct RefinementConfig
{
  double bridge_distance_m = 0.3;  ///< objects of one group of classes that are closer are one; 0: never
  bool split = true;               ///< objects too big for their class are cut where they hang together least
  double size_margin = 1.3;        ///< factor on the class's usual size above which an object is too big
  bool merge = true;               ///< parts that together still fit one object of their class are joined
  bool vote = true;                ///< all points of an instance get the class of most of them
  int min_points = 1;              ///< smaller instances get id 0; 1 keeps all

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("bridge_distance_m", self.bridge_distance_m, 0.0, 10.0);
    visitor("split", self.split);
    visitor("size_margin", self.size_margin, 1.0, 10.0);
    visitor("merge", self.merge);
    visitor("vote", self.vote);
    visitor("min_points", self.min_points, 1, 10000);
  }
};

/// From a clusterer's components to numbered instances, in small steps; buffers are kept between scans.
class Refinement
{
public:
  /// Throws std::invalid_argument on a value outside its range.
  Refinement(std::shared_ptr<const ClassTable> table, const RefinementConfig& config);

  /// Bridge, split what is too big, merge parts, number. Ids are 1..n by the first pixel in row-major order.
  /// Linear in the thing points, but for what splitting and merging take.
  void refine(const ThingScan& scan, const std::vector<std::uint32_t>& component, Instances& instances);

private:
  /// An object to be split, or a part of it.
  struct Range
  {
    std::uint32_t object;
    std::uint32_t begin, end;             ///< of things_, or of leaves_
    int tenths = BoxSplitter::kCoarsest;  ///< the distance to begin with
  };

  void gather(const ThingScan& scan, const std::vector<std::uint32_t>& component);
  void findClasses(const ThingScan& scan);
  void addRun(const ThingScan& scan, std::uint32_t begin, std::uint32_t end, RefinedObject& object,
              std::uint32_t* votes) const;
  std::uint32_t* votesOf(std::uint32_t object) { return votes_.data() + object * classes_.size(); }
  void elect(std::uint32_t object);
  void bridge(const ThingScan& scan);
  void moveInto(std::uint32_t from, std::uint32_t to, bool is_first);
  bool isTooBig(const RefinedObject& object) const;
  void splitTooBig(const ThingScan& scan);
  void split(const ThingScan& scan, Range range);
  void countLeafVotes(const ThingScan& scan, Range range);
  void splitPart(Range part);
  void fillFromLeaves(std::uint32_t object, const std::uint32_t* leaves, std::uint32_t count);
  void assignThings(const ThingScan& scan, Range range);
  void openAgain(Range range);
  void number(const ThingScan& scan, Instances& instances);
  std::uint32_t numbered(const RefinedObject& object, Instances& instances) const;

  std::shared_ptr<const ClassTable> table_;
  RefinementConfig config_;
  std::vector<RefinedObject> objects_;
  std::vector<ClassIndex> classes_;             ///< that occur in the scan
  std::vector<std::uint32_t> column_of_class_;  ///< place in classes_, by class
  std::vector<std::uint32_t> votes_;            ///< object x classes_
  std::vector<std::uint32_t> object_of_thing_, object_of_component_;
  ClassBridging bridging_;
  BoxSplitter splitter_;
  PartMerger merger_;
  std::vector<std::uint32_t> whole_of_, id_of_;  ///< by object

  std::vector<std::uint32_t> things_;  ///< of the objects too big for their class, object by object
  std::vector<Range> open_;            ///< objects that are still to be split
  std::vector<std::uint32_t> slot_of_;
  // of the object in hand
  std::vector<Range> parts_;           ///< that are still to be split
  std::vector<Range> other_reach_;     ///< parts whose class has another link distance: to be taken as objects
  std::vector<std::uint32_t> leaves_;  ///< part by part
  std::vector<std::uint32_t> part_of_leaf_, sorted_, object_of_leaf_;
  std::vector<std::uint32_t> leaf_votes_;  ///< leaf x classes_
};
}  // namespace lidar_panoptic_clustering
