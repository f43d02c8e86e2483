#include "lidar_panoptic_clustering/tracking/tracker.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = SparseAssignment::kNone;
constexpr std::uint32_t kOld = 12;                    ///< scans that make a track to which others are parts
constexpr std::uint32_t kFewPoints = 25;              ///< so few may be a part; of more, size does not tell
constexpr float kShortestM = 3.0F, kLongestM = 6.0F;  ///< length of classes as large as a car
}  // namespace

/// Whether what was seen lies within the outline the track had, and may be of one object with what was seen of it. The
/// outline alone does not tell: two people who were one instance before have one track.
bool Tracker::isPartOf(const Observation& observation, std::uint32_t track) const
{
  constexpr float kMarginM = 0.5F;
  if (tracks_[track].object.scans < 2) return false;
  const ClassInfo &ours = (*table_)[tracks_[track].object.class_index], &theirs = (*table_)[observation.class_index];
  if (ours.group != theirs.group) return false;
  const Extent& outline = expected_[track].outline;
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
    if (observation.extent.min[k] < outline.min[k] - kMarginM || observation.extent.max[k] > outline.max[k] + kMarginM)
      return false;
  if (!isSmall(ours)) return true;
  Extent together = whole_[track].extent;
  together.add(observation.extent);
  return together.fits(ours.length_m, ours.width_m);
}

/// Whether a track that was seen for long, with what was seen of it, and an observation with the track it has, `own`,
/// are together no larger than one object, and one of them is a few points: far out, and behind a windscreen, a car is
/// torn where hardly a beam comes back. Size tells only of classes as large as a car: two people, or two bicycles,
/// stand so near to each other that both are hardly larger than one, and two cars fit into a truck. With many points it
/// does not tell either: the fronts of two cars that are parked side by side fit into the outline of one.
bool Tracker::isSameObject(const Observation& observation, std::uint32_t own, std::uint32_t track) const
{
  const ClassInfo &ours = (*table_)[tracks_[track].object.class_index], &theirs = (*table_)[observation.class_index];
  if (ours.group != theirs.group || ours.length_m < kShortestM || ours.length_m > kLongestM) return false;
  if (tracks_[track].object.scans < kOld) return false;
  if (std::min(observation.point_count, whole_[track].point_count) > kFewPoints) return false;
  Extent together = whole_[track].extent;
  together.add(observation.extent);
  together.add(expected_[track].outline);
  if (own != kNone) together.add(expected_[own].outline);
  return together.fitsTurned(kIsTwo * ours.length_m, kIsTwo * ours.width_m);
}

/// Whether two tracks that an instance holds are of one vehicle: with all that was seen they are no larger than one,
/// and either one of them is a few points or the older one drives. Two that are parked may stand so near, two that
/// drive do not.
bool Tracker::areOneCar(std::uint32_t own, std::uint32_t other, const Extent& seen) const
{
  constexpr double kDrives = 2.0;  // [m/s]
  const ClassInfo &ours = (*table_)[tracks_[own].object.class_index],
                  &theirs = (*table_)[tracks_[other].object.class_index];
  if (ours.group != theirs.group || ours.length_m < kShortestM || theirs.length_m < kShortestM) return false;
  const std::uint32_t older = std::min(own, other);  // tracks_ is in order of birth
  const bool drives = tracks_[older].object.scans >= kOld && expected_[older].motion.mean.tail<2>().norm() > kDrives;
  const bool is_fragment = std::min(tracks_[own].points, tracks_[other].points) <= kFewPoints;
  if (!drives && (!is_fragment || ours.length_m > kLongestM)) return false;
  Extent together = expected_[own].outline;
  together.add(expected_[other].outline);
  together.add(seen);
  return together.fitsTurned(kIsTwo * ours.length_m, kIsTwo * ours.width_m);
}

/// Ends the tracks of an observation's vehicle that the scan shows in nothing else: fragments of it had them when it
/// came into sight. The one that was seen for longer and with more points stays.
void Tracker::endDoubles(const Observations& observations, std::uint32_t i)
{
  std::uint32_t& own = track_of_[i];
  const Extent& seen = observations.list[i].extent;
  for (std::uint32_t c = candidates_begin_[i]; c < candidates_begin_[i + 1] && own != kNone; ++c)
  {
    const std::uint32_t other = candidates_[c].track;
    if (other == own || observed_in_[other] != kNone) continue;
    if (expected_[other].outline.shareWithin(seen) < kHeld || !areOneCar(own, other, seen)) continue;
    const bool is_main = tracks_[other].most_points > tracks_[own].most_points &&
                         tracks_[other].object.scans > tracks_[own].object.scans;
    ended_.push_back(is_main ? own : other);
    if (!is_main) continue;
    observed_in_[own] = kNone, observed_in_[other] = i;
    own = other;
  }
}

/// Whether an observation is a part of a track that is seen elsewhere too: it has no track, a younger one of the same
/// object, or a fragment's.
bool Tracker::isTorn(const Observation& observation, std::uint32_t own, std::uint32_t track) const
{
  constexpr std::uint32_t kFragment = 5;  // scans
  if (own == track || observed_in_[track] == kNone) return false;
  const bool is_older = own == kNone || track < own;  // tracks_ is in order of birth
  if (is_older && isSameObject(observation, own, track)) return true;
  const bool is_free = own == kNone || (tracks_[own].object.scans < kFragment && tracks_[track].object.scans >= kOld);
  return is_free && isPartOf(observation, track);
}

/// Gives instances that are left, or have a track that is none of its own, to the track they are a part of; whole_ is
/// what was seen of each track.
void Tracker::joinParts(const Observations& observations)
{
  ended_.clear();
  for (std::uint32_t i = 0; i < track_of_.size(); ++i) endDoubles(observations, i);
  whole_.resize(tracks_.size());
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    if (observed_in_[t] != kNone) whole_[t] = observations.list[observed_in_[t]];
  for (std::uint32_t i = 0; i < track_of_.size(); ++i)
  {
    std::uint32_t best = kNone;
    float least = 0.0F;
    for (std::uint32_t c = candidates_begin_[i]; c < candidates_begin_[i + 1]; ++c)
    {
      const auto [track, cost] = candidates_[c];
      if (!isTorn(observations.list[i], track_of_[i], track)) continue;
      if (best == kNone || cost < least) best = track, least = cost;
    }
    if (best != kNone) join(observations.list[i], track_of_[i], best);
  }
}

/// Makes an observation a part of a track. One that it had, and that is the same object, is not to come again.
void Tracker::join(const Observation& observation, std::uint32_t& own, std::uint32_t track)
{
  if (own != kNone)
  {
    observed_in_[own] = kNone;
    if (isSameObject(observation, own, track)) ended_.push_back(own);
  }
  own = track;
  whole_[track].extent.add(observation.extent);
  whole_[track].point_count += observation.point_count;
}
}  // namespace lidar_panoptic_clustering
