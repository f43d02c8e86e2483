#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/geometry/voxel_index.h"
#include "lidar_panoptic_clustering/tracking/motion.h"
#include "lidar_panoptic_clustering/tracking/observation.h"
#include "lidar_panoptic_clustering/tracking/sparse_assignment.h"

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Parameters of the tracker.
struct TrackerConfig
{
  double max_missed_s = 1.5;   ///< an object that is not seen for longer is a new one when it comes again
  bool vote_over_time = true;  ///< an object has the class it had most often, where that is clear; its points too

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("max_missed_s", self.max_missed_s, 0.0, 60.0);
    visitor("vote_over_time", self.vote_over_time);
  }
};

/// An object as it is known after a scan.
struct TrackedObject
{
  std::uint32_t track = 0;                                        ///< its id, from 1; never given twice by one tracker
  ClassIndex class_index = kUnknownClass;                         ///< voted over its life, see TrackerConfig
  std::int64_t first_seen_us = 0, last_seen_us = 0;               ///< stamps
  std::uint32_t scans = 0;                                        ///< in which it was seen
  Eigen::Vector2d position = Eigen::Vector2d::Zero();             ///< of a point that moves with it, fixed frame [m]
  Eigen::Matrix2d position_covariance = Eigen::Matrix2d::Zero();  ///< of the position [m^2]
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();             ///< over ground, in the axes of the fixed frame [m/s]
  Eigen::Matrix2d velocity_covariance = Eigen::Matrix2d::Zero();  ///< of the velocity [m^2/s^2]
};

/// Ids that stay with an object from scan to scan.
///
/// Tracking by detection as in AB3DMOT [Weng 2020]: each track is predicted by a Kalman filter of constant velocity, an
/// exact assignment matches predictions and instances, what is left of instances is born and what is left of tracks
/// lives on for a while. As in training-free 4D panoptic segmentation [Oh et al. 2025, arXiv 2512.18991] objects at
/// rest are held by their overlap in a fixed frame and missing ones are kept for as long as they may be hidden. What
/// differs: no boxes of a detector but outlines of points, of which part is hidden, so that innovations are taken from
/// the edges that stay (see displacementOf), and numbers of points, which change little from scan to scan, tell an
/// object from its fragments; an id is given in the first scan; and parts into which a scan tears an object take its id
/// when they lie within the outline it had.
///
/// Linear in the objects, which are looked up on a grid, as long as they lie no denser than real ones. Allocates
/// nothing once its buffers have grown. The same input gives the same ids. Not shared between threads.
class Tracker
{
public:
  /// Throws std::invalid_argument without a table, and on a value outside its range.
  explicit Tracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config = {});

  /// Exchanges the parameters; keeps the tracks.
  void configure(const TrackerConfig& config);

  /// Follows a scan's instances; returns one object each, in their order, valid until the next call. A scan that is not
  /// later than the one before (it comes twice or out of order) gets its ids but teaches nothing; one that is earlier
  /// by more than max_missed_s starts anew, see reset().
  const std::vector<TrackedObject>& update(std::int64_t stamp_us, const Observations& observations);

  /// A track that an observation holds together with others.
  struct Share
  {
    std::uint32_t observation;  ///< its place
    Extent outline;             ///< where the track should be, from Observations::origin
    bool is_sure;               ///< with any of the others it is larger than one object of the class
    bool is_known = false;      ///< its track is of one person, seen for long enough to be no fragment
  };
  /// The tracks of observations that hold more than one: they lie within it, side by side, and nothing else is seen of
  /// them. By observation; valid until the next call. Teaches nothing.
  const std::vector<Share>& findMerged(std::int64_t stamp_us, const Observations& observations);
  /// update() of the scan that findMerged() was given last: goes on from there. The observations have to be the same.
  const std::vector<TrackedObject>& updateMatched(std::int64_t stamp_us, const Observations& observations);

  /// Forgets all tracks (a jump in time, another sequence). Ids go on from the last one.
  void reset();
  /// Forgets all tracks and numbers from 1 again.
  void restart();

  std::size_t liveTracks() const { return tracks_.size(); }  ///< tracks that may still be seen again
  /// Whether the track may still be seen again. Logarithmic in the tracks.
  bool isAlive(std::uint32_t track) const;

private:
  static constexpr float kDearest = 14.0F;  ///< what a pair may cost, penalties included
  static constexpr float kIsTwo = 1.15F;    ///< times a class's usual size: larger than one object is
  static constexpr float kHeld = 0.3F;      ///< of an outline: so much of a track that is held in an observation

  struct Track
  {
    TrackedObject object;
    MotionState motion;
    Extent outline;            ///< from the position
    float points = 0.0F;       ///< in the last scan it was seen in
    float most_points = 0.0F;  ///< of late; what goes behind something comes out with as many
    ClassIndex prior_class;    ///< of its first scan, or what the vote says
    bool has_ended = false;    ///< it turned out to be another track's object
  };
  /// Where a track should be in the scan in hand.
  struct Expected
  {
    MotionState motion;
    Extent outline;  ///< from Observations::origin
  };
  struct Candidate
  {
    std::uint32_t track;
    float cost;
  };

  struct Held
  {
    float rank;  ///< the higher, the sooner it has its share
    std::uint32_t track;
    bool must_be_sure;  ///< it has a share only where that is sure, see Share
  };

  void match(std::int64_t stamp_us, const Observations& observations);
  void shareOut(const Observations& observations, std::uint32_t i);
  void findHeld(const Observations& observations, std::uint32_t i);
  void share(std::uint32_t i, const Held& held, std::size_t first);
  void expect(double dt, const Eigen::Vector3d& origin);
  void enterIntoGrid();
  void findCandidates(const Observations& observations);
  void collect(const Observation& observation, std::uint32_t number);
  float costOf(const Observation& observation, std::uint32_t track) const;
  double penaltyOf(const Observation& observation, std::uint32_t track) const;
  void assign(const Observations& observations);
  void joinParts(const Observations& observations);
  void join(const Observation& observation, std::uint32_t& own, std::uint32_t track);
  bool isPartOf(const Observation& observation, std::uint32_t track) const;
  bool isSameObject(const Observation& observation, std::uint32_t own, std::uint32_t track) const;
  bool areOneCar(std::uint32_t own, std::uint32_t other, const Extent& seen) const;
  void endDoubles(const Observations& observations, std::uint32_t i);
  bool isTorn(const Observation& observation, std::uint32_t own, std::uint32_t track) const;
  void learn(std::int64_t stamp_us, const Observations& observations);
  static void tellMotion(Track& track);
  void follow(Track& track, const Expected& expected, const Observation& seen, const Eigen::Vector3d& origin);
  void vote(std::uint32_t track, const Observation& observation);
  bool isOverruled(std::uint32_t track, ClassIndex seen) const;
  void dropLost(std::int64_t stamp_us);
  void giveIds(std::int64_t stamp_us, const Observations& observations, bool is_new);
  std::uint32_t bear(std::int64_t stamp_us, const Observation& observation, const Eigen::Vector3d& origin);
  double noiseOf(const Observation& observation) const;

  std::shared_ptr<const ClassTable> table_;
  TrackerConfig config_;
  std::vector<MotionPrior> prior_;  ///< by ClassIndex
  std::uint32_t next_id_ = 1;
  std::int64_t last_us_ = 0;
  bool has_begun_ = false;

  std::vector<Track> tracks_;
  std::vector<float> votes_;  ///< by track and class
  std::vector<Expected> expected_;

  VoxelIndex grid_;
  struct Entry
  {
    std::uint32_t track, next;
  };
  std::vector<std::uint32_t> first_in_cell_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> looked_at_;  ///< by track: the observation that looked at it last, + 1
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> candidates_begin_;  ///< by observation

  SparseAssignment assignment_;
  std::vector<std::uint32_t> track_of_;     ///< by observation: place in tracks_, or kNone
  std::vector<std::uint32_t> observed_in_;  ///< by track: the observation assigned to it, or kNone
  std::vector<bool> is_part_;               ///< by observation: of the track, which is seen in another one too
  std::vector<Observation> whole_;          ///< by track: what was seen of it, parts included
  std::vector<std::uint32_t> ended_;        ///< tracks that turned out to be others'
  std::vector<TrackedObject> objects_;
  std::vector<Share> shares_;
  std::vector<Held> held_;  ///< by the observation in hand
};
}  // namespace lidar_panoptic_clustering
