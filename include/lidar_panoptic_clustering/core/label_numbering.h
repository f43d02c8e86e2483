#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/point_types.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Names what no id can be read of as -1, which is what is sent for it most often.
std::string idText(std::uint32_t id);

/// Tells over a stream of scans whether its class ids are those of the table they are read by.
///
/// Networks publish raw ids, training ids, training ids less one: numberings that share many of their ids, so that one
/// scan's set of ids, or a share of its points, decides nothing. What counts is
/// - the ids seen so far: one that the table lacks, by more than the share allowed, is against it, and stays so for the
///   scans after it, unless the stream has shown an id that no other shipped table has;
/// - what the ids lie on, from neighbouring scan lines: objects and structure as flat as the ground, ground that stands
///   upright, an ignored id for much of the ground; and from runs along a line: persons and two-wheelers many times
///   longer than any.
///
/// Linear in the pixels, of which the shapes look at a quarter; allocates only where a new id comes. Not shared between
/// threads.
class LabelNumbering
{
public:
  struct Config
  {
    bool chosen = false;              ///< somebody named the table; else it stands for want of another
    double max_unknown_labels = 0.0;  ///< share of the labelled returns whose id the table may lack
    bool check_shapes = true;
  };

  LabelNumbering(std::shared_ptr<const ClassTable> table, const Config& config);

  /// Takes one more scan: `image` by its scan lines (those of one row have no shapes), where pixels without a return
  /// have NaN coordinates; `hidden`: ids of returns that no pixel shows. Throws std::invalid_argument with what was
  /// expected, what was found, and the shipped tables that would fit, where the stream is not of the table.
  void check(const LabelledCloud& image, const std::vector<std::uint32_t>& hidden = {});

  /// Which other shipped tables the ids so far would fit as well, and what to do; empty where none does, or the table
  /// was chosen.
  const std::string& doubt() const { return doubt_; }

private:
  static constexpr std::array<float, 4> kRunLengths = {8.0F, 12.0F, 20.0F, 42.0F};  // [m]

  /// What a class must look like.
  enum class Shape : std::uint8_t
  {
    kAny,
    kFlat,      ///< ground
    kStanding,  ///< objects and structure
    kNotGround  ///< ignored, but not what stands for "no class"
  };
  struct Expectation
  {
    Shape shape = Shape::kAny;
    int longest_run = -1;  ///< index in kRunLengths, -1 for no limit
  };
  /// A table that the ids may be of.
  struct Candidate
  {
    explicit Candidate(std::shared_ptr<const ClassTable> class_table);
    std::shared_ptr<const ClassTable> table;
    std::vector<Expectation> of_class;
  };
  /// What is known of an id.
  struct Seen
  {
    std::uint32_t id = 0;
    bool lacking = false, distinctive = false;
    std::uint64_t scan = 0;   ///< the last one that had it
    std::size_t returns = 0;  ///< in that scan
    double flat = 0.0, steep = 0.0, pairs = 0.0;
    double run_points = 0.0;
    std::array<double, kRunLengths.size()> long_run_points{};
  };
  enum class Misfit : std::uint8_t
  {
    kNone,
    kFlat,
    kUpright,
    kLong
  };

  static const std::vector<Candidate>& shippedCandidates();
  static bool isReturn(const LabelledPoint& p)
  {
    const float zero = p.x * 0.0F + p.y * 0.0F + p.z * 0.0F;  // NaN where one of them is infinite or NaN
    return zero == 0.0F && (p.x != 0.0F || p.y != 0.0F || p.z != 0.0F);
  }
  Seen& seen(std::uint32_t id);
  void count(const LabelledCloud& image, const std::vector<std::uint32_t>& hidden);
  void lookAtShapes(const LabelledCloud& image);
  void lookAlongLines(const LabelledCloud& image);
  void addRun(Seen& id, float length, std::size_t points) const;
  void forgetHalf();

  Misfit misfit(const Seen& id, const Candidate& candidate) const;
  bool fits(const Candidate& candidate) const;
  std::string fittingTables() const;
  void requireIds();
  void requireShapes() const;
  void describeDoubt();
  std::string seenIds() const;

  Candidate own_;
  Config config_;
  std::vector<std::uint16_t> slot_of_id_;  ///< in seen_, by id; the last one stands for all beyond
  std::vector<Seen> seen_;
  std::uint64_t scan_ = 0;
  double ground_pairs_ = 0.0;  ///< flat pairs of all ids
  bool lacking_ = false;       ///< the stream had ids that the table lacks
  int clean_scans_ = 0;        ///< since the last of them
  std::size_t described_ = 0;  ///< ids known when the doubt was described
  std::string doubt_;
};
}  // namespace lidar_panoptic_clustering
