#pragma once

#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"

namespace lidar_panoptic_clustering
{
/// The parameters of ScanLineRunClusterer.
struct ScanLineRunConfig
{
  double run_distance_m = 0.5;   ///< consecutive points of a scan line closer than this form a run
  double line_distance_m = 1.0;  ///< runs of near lines with two points closer than this are one object
  int max_line_gap = 2;          ///< lines this far apart count as near
  int max_window_px = 256;       ///< columns searched either side at the most; bounds the work beside the sensor

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("run_distance_m", self.run_distance_m, 0.01, 10.0);
    visitor("line_distance_m", self.line_distance_m, 0.01, 10.0);
    visitor("max_line_gap", self.max_line_gap, 1, 16);
    visitor("max_window_px", self.max_window_px, 1, 2048);
  }
};

/// Scan-line run clustering (Zermas et al., "Fast Segmentation of 3D Point Clouds: A Paradigm on LiDAR Data for
/// Autonomous Vehicle Applications", ICRA 2017, section IV; settings of Zhao et al. 2021).
///
/// A run is a chain of linkable thing points of one scan line, each closer than run_distance_m (and the link distance)
/// to the one before, whatever lies between them; on a full turn the last point of a line is followed by the first. Two
/// runs at most max_line_gap lines apart are one object when two linkable points of theirs are closer than
/// line_distance_m (and the link distance) and lie within each other's window: asin(min(1, line_distance_m / horizontal
/// range)) of azimuth either side, in columns and rounded up, at most max_window_px.
///
/// Runs that are one object already are not compared again, so that a scan costs little more than its runs' overlaps.
/// Where that does not help, in lines of many short runs or of runs that lie close but do not join, points are compared
/// one by one with those of about their range, but for those known to be of their object, eight at a time with the
/// processor's vectors; at the most points x 2 max_line_gap x max_window_px comparisons.
class ScanLineRunClusterer : public Clusterer
{
public:
  /// For the factory.
  using Config = ScanLineRunConfig;

  /// Throws std::invalid_argument on a value outside its range.
  explicit ScanLineRunClusterer(const ScanLineRunConfig& config = {});

  void cluster(const ThingScan& scan, std::vector<std::uint32_t>& component) override;
  bool needsScanLines() const override { return true; }

  /// Pairs of points and of runs compared in the last scan, for tests that bound the work.
  std::size_t pairsLookedAt() const { return looked_at_; }

private:
  struct Point
  {
    float x, y, z;
    int column;
    int window;           ///< columns searched either side
    std::uint32_t thing;  ///< index in the ThingScan
    float link_distance;  ///< of its class [m]
  };

  /// A chain of points of one scan line and one link key, by column: [begin, end) of points_.
  struct Run
  {
    std::uint32_t begin, end;
    int first_column, last_column;
    int window;            ///< the widest of its points
    float min[3], max[3];  ///< bounding box [m]
  };

  /// Points of a slot whose horizontal range is about the same, by column: [begin, end) of lower_.
  struct Layer
  {
    std::uint32_t begin, end;
    float min_range, max_range, min_z, max_z;  ///< [m]
    std::uint32_t same_begin, same_end;        ///< of these it is known that they are of one object
    std::uint32_t from, to;                    ///< the window of the point looked at last
  };

  /// The longest stretch of points of one object among neighbouring ranges that are added one after the other.
  class Stretch
  {
  public:
    explicit Stretch(std::uint32_t begin) : begin_(begin), end_(begin), longest_begin_(begin), longest_end_(begin) {}
    /// The points up to `end`: whether all are of the object.
    void add(std::uint32_t end, bool are_same)
    {
      end_ = end;
      if (!are_same) begin_ = end;
      if (end_ - begin_ > longest_end_ - longest_begin_) longest_begin_ = begin_, longest_end_ = end_;
    }
    std::uint32_t longestBegin() const { return longest_begin_; }
    std::uint32_t longestEnd() const { return longest_end_; }

  private:
    std::uint32_t begin_, end_, longest_begin_, longest_end_;
  };

  void sortByLink(const ThingScan& scan);
  void findRuns(const ThingScan& scan);
  void joinOverTheWrap();
  void linkLines(std::uint32_t upper_slot, std::uint32_t lower_slot, int turn);
  bool linkRuns(std::uint32_t upper_slot, std::uint32_t lower_slot, int turn);
  bool anyPairClose(const Run& upper, const Run& lower, int shift);
  void linkPoints(std::uint32_t upper_slot, std::uint32_t lower_slot, int turn);
  float layersPerMetre(std::uint32_t slot) const;
  void sortByRange(std::uint32_t slot);
  void linkPoint(const Point& p, int shift);
  void linkLayer(const Point& p, int shift, Layer& layer, std::uint32_t& object);
  std::uint32_t moveTo(int column, const Layer& layer, std::uint32_t k) const;
  bool joinAny(const Point& p, int shift, std::uint32_t begin, std::uint32_t end, std::uint32_t& object);
  void linkRange(const Point& p, int shift, std::uint32_t from, std::uint32_t to, std::uint32_t& object, Stretch& same);
  bool linkBlock(const Point& p, int shift, std::uint32_t begin, std::uint32_t end, std::uint32_t& object);

  ScanLineRunConfig config_;
  float run_distance_, line_distance_;
  std::uint32_t columns_ = 0;  ///< of the scan

  // A slot is a scan line and a link key: row * link_count + link.
  std::vector<Point> points_;              ///< by slot, then column
  std::vector<std::uint32_t> slot_begin_;  ///< into points_, one entry more than slots
  std::vector<Run> runs_;                  ///< by slot, then column
  std::vector<std::uint32_t> slot_run_;    ///< into runs_, one entry more than slots
  std::vector<std::uint32_t> run_of_thing_;
  std::vector<std::uint32_t> representative_;
  DisjointSets sets_;  ///< of runs
  std::size_t looked_at_ = 0;

  /// The points of a slot, layer by layer and coordinate by coordinate, for linkPoints().
  struct Columns
  {
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> object;  ///< of the point's run, as it was when it was looked up last
    std::vector<int> column;
    std::vector<std::uint32_t> point;  ///< of points_
    std::vector<Layer> layers;         ///< by range
    float layers_per_m = 0.0F;         ///< 0: one layer
    std::uint32_t slot = 0xFFFFFFFF;   ///< whose points these are
  };
  Columns lower_;
  std::vector<std::uint32_t> layer_of_point_, layer_begin_;
};
}  // namespace lidar_panoptic_clustering
