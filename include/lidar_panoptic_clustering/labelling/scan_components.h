#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"
#include "lidar_panoptic_clustering/labelling/column_cuts.h"
#include "lidar_panoptic_clustering/labelling/ground_surface.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How high something stands.
struct HeightRange
{
  static constexpr float kFar = std::numeric_limits<float>::infinity();  ///< beyond any height

  std::uint32_t point_count = 0;     ///< its returns
  float bottom = kFar, top = -kFar;  ///< [m] above the ground
  bool open_top = false;             ///< goes up to the highest beam: there may be more of it above

  void add(const HeightRange& other);  ///< joins the other one to it
  void widen(float height) { bottom = std::min(bottom, height), top = std::max(top, height); }  ///< to hold it [m]
};

/// Returns above the ground that hang together, and what of them tells an object from a wall or a tree.
struct ScanComponent : HeightRange
{
  Footprint footprint;  ///< in bird's-eye view

  /// Columns in which a beam came by below the lowest return, where a vehicle has its gap to the ground: `blocked`
  /// beams ended at the component's foot, `undercut` ones went on underneath. A beam that met the ground before it came
  /// there tells nothing and is not counted.
  std::uint32_t blocked = 0, undercut = 0;
  /// Columns in which another component, nearer, stands before what is below the lowest return.
  std::uint32_t hidden = 0;

  /// Triples of neighbours in a scan line, and those that no smooth surface has, as foliage, by more than the noise of
  /// ranges bends the ground.
  std::uint32_t triples = 0, rough_triples = 0;

  /// Ends of its pieces of scan lines, and those where what comes next lies behind it, or nothing does: it stands free.
  std::uint32_t ends = 0, free_ends = 0;

  void addShape(const ScanComponent& other);  ///< joins the other one to it, but for its heights
};

/// The connected components of the returns above the ground, on the range image, at two distances.
///
/// A return's neighbours are the next such returns beside it and above it, up to 8 columns and 4 rows away (a window, a
/// missing return). Two neighbours hang together when they are closer than a distance, or when the surface through them
/// is within 60 degrees of upright to the beam, as far out, where neighbouring beams part. What hangs together at the
/// step is a part, and such a surface counts only as long as it does not step along the beam by more than that: beams
/// apart, a counter behind a person's side looks like one slanted surface with it. Parts that hang together at the link
/// are a component. So a person before a wall is a part, though not a component.
///
/// Linear in the pixels; keeps its memory.
class ScanComponents
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;  ///< no component

  /// [m]
  struct Distances
  {
    float above;       ///< the ground, from there on returns are taken
    float step, link;  ///< step <= link
  };

  /// Begins with a scan of `rows` x `columns`. `full_turn`: the last column is the first one's neighbour.
  void start(std::uint32_t rows, std::uint32_t columns, const Distances& distances, bool full_turn);
  /// The rows one after the other, from the highest beam down or from the lowest up.
  void addRow(std::uint32_t row, const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns);
  /// After the last row. `is_apart` tells which parts are described on their own, by their heights: all others, most of
  /// them a few leaves, by their components alone.
  void finish(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
              const std::function<bool(const HeightRange&)>& is_apart);
  /// Then, columns of the given parts in which someone may stand, and above which the beams go farther, become parts of
  /// their own, the last of partsApart(), in the same component; see ColumnProfile. What is left of a part stays
  /// measured as it was, and so do components. Linear in the runs of neighbours and the given parts' returns.
  void cutColumns(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                  const std::vector<std::uint32_t>& parts);

  /// Numbered by first pixel in row-major order.
  std::uint32_t partCount() const { return static_cast<std::uint32_t>(heights_.size()); }
  /// The parts that are described on their own, in the order of their numbers.
  const std::vector<std::uint32_t>& partsApart() const { return parts_apart_; }
  /// Of one of them.
  const ScanComponent& part(std::uint32_t part) const { return described_[description_of_part_[part]]; }
  /// Numbered by first part.
  std::uint32_t componentCount() const { return component_count_; }
  /// The sum of its parts.
  const ScanComponent& component(std::uint32_t component) const { return described_[component]; }
  /// By part.
  const std::vector<std::uint32_t>& componentOfPart() const { return component_of_part_; }

  /// The pixels of the returns above the ground, in row-major order.
  const std::vector<std::uint32_t>& pixels() const { return pixels_; }
  /// The pixels of returns below where parts begin that are the feet of what stands there: below a part and as far
  /// away, one after the other, or beneath a gap of up to 4 rows through which beams went on, as between a fence's
  /// rails and the low wall that these stand on. Close to the ground only while they fall by more than they come
  /// nearer, as faces do and the ground does not.
  const std::vector<std::uint32_t>& feet() const { return feet_; }
  /// The part of a pixel, kNone for those without.
  std::uint32_t partOf(std::size_t pixel) const { return part_of_[pixel]; }
  /// The component of a pixel, kNone for those without.
  std::uint32_t of(std::size_t pixel) const
  {
    return part_of_[pixel] == kNone ? kNone : component_of_part_[part_of_[pixel]];
  }

private:
  struct Pair
  {
    std::uint32_t a, b;
  };
  class RowLinker;
  static constexpr std::uint32_t kNoPixel = 0x80000000;  ///< farther from any pixel than the reach
  static constexpr std::uint32_t kColumnReach = 8, kRowReach = 4;

  std::size_t gatherRow(const GroundedReturn* row, std::uint32_t begin, std::uint32_t* to);
  void numberParts(const std::vector<GroundedReturn>& returns);
  void joinParts();
  void setApart(const std::function<bool(const HeightRange&)>& is_apart);
  void describeApart(std::uint32_t part);
  void examineTops(const LabelledCloud& cloud);
  void examineFeet(const std::vector<GroundedReturn>& returns);
  void examineFoot(const std::vector<GroundedReturn>& returns, std::uint32_t pixel);
  void measureNoise(const std::vector<GroundedReturn>& returns);
  void measureRun(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t run);
  void measurePiece(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t first,
                    std::uint32_t length);
  void cutPart(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t part);
  void gatherCuts(std::uint32_t part, std::uint32_t count);
  bool isFreeAbove(const std::vector<GroundedReturn>& returns, const std::vector<std::uint32_t>& cut) const;
  void addCut(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t from,
              const std::vector<std::uint32_t>& cut);
  void takeFeet(const std::vector<GroundedReturn>& returns, std::uint32_t from, const std::vector<std::uint32_t>& cut);
  void examineEnd(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, std::uint32_t pixel,
                  std::int32_t direction);

  std::uint32_t rows_ = 0, columns_ = 0;
  Distances distances_{};
  bool full_turn_ = false;
  std::uint32_t down_ = 0;  ///< from a pixel to that of the next beam below; below the lowest it leads out of the image
  DisjointSets sets_;
  std::vector<std::uint32_t> part_of_;
  std::vector<std::uint32_t> pixels_;        ///< of the returns above the ground, in row-major order
  std::vector<std::uint32_t> row_pixels_;    ///< those of the row in hand, and a place more
  std::vector<std::uint32_t> begin_of_run_;  ///< in pixels_; a run lies in one row, and the runs one after the other
  std::vector<std::uint32_t> pixel_before_;  ///< by column: that of the last return above the ground
  std::vector<std::uint32_t> feet_;
  std::vector<std::int32_t> has_return_;  ///< by column: not 0
  std::vector<Pair> loose_;               ///< runs closer than the link, not the step
  std::vector<std::uint32_t> part_of_run_;
  std::vector<HeightRange> heights_;      ///< by part
  std::vector<ScanComponent> described_;  ///< the components, and then the parts that are apart
  std::vector<std::uint32_t> parts_apart_, description_of_part_;
  std::vector<std::uint32_t> component_of_part_;
  std::uint32_t component_count_ = 0;
  ColumnProfile profile_;
  std::vector<std::uint32_t> first_run_, next_run_;  ///< by part, by run: of the given parts
  std::vector<std::vector<std::uint32_t>> cuts_;     ///< of the part in hand: their pixels
  std::vector<float> bends_;                         ///< of the ground, some of them [m]
  float bend_noise_ = 0.0F;                          ///< [m]
};
}  // namespace lidar_panoptic_clustering
