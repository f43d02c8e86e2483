#include "lidar_panoptic_clustering/tracking/tracker.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = SparseAssignment::kNone;

/// How much of the shorter of two intervals the other one covers, along the axis where that is least; below 0 where
/// there is a gap.
float leastOverlap(const Extent& a, const Extent& b)
{
  float least = 1.0F;
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    const float shared = std::min(a.max[k], b.max[k]) - std::max(a.min[k], b.min[k]);
    const float shorter = std::min(a.max[k] - a.min[k], b.max[k] - b.min[k]);
    least = std::min(least, shared / std::max(shorter, 0.1F));
  }
  return least;
}
}  // namespace

/// Lists the tracks that should be within an observation or reach into it, the ones seen in nothing else first.
void Tracker::findHeld(const Observations& observations, std::uint32_t i)
{
  constexpr std::uint32_t kFewest = 3;                                // scans that make a track more than a fragment
  constexpr float kOwnLeast = 0.2F, kReach = 0.15F;                   // share of the outline
  constexpr float kFragment = 0.5F;                                   // of the points it had
  constexpr float kOwn = 3.0F, kSeenNowhere = 1.0F, kSeenToo = 1.0F;  // in rank
  held_.clear();
  const auto& group = (*table_)[observations.list[i].class_index].group;
  for (std::uint32_t c = candidates_begin_[i]; c < candidates_begin_[i + 1]; ++c)
  {
    const std::uint32_t track = candidates_[c].track, in = observed_in_[track];
    if (tracks_[track].object.scans < kFewest || (*table_)[tracks_[track].object.class_index].group != group) continue;
    const Extent& outline = expected_[track].outline;
    const float held = outline.shareWithin(observations.list[i].extent);
    if (in == i && held > kOwnLeast) held_.push_back({kOwn, track, false});
    if (in == i || held < kReach) continue;
    const bool is_elsewhere =
        in != kNone && static_cast<float>(observations.list[in].point_count) >= kFragment * tracks_[track].points;
    if (!is_elsewhere)  // nor is it where the scan has torn a fragment off
      held_.push_back({kSeenNowhere + held, track, held < kHeld});
    else if (outline.shareWithin(observations.list[in].extent) <= 0.0F)  // it was given what is none of its own
      held_.push_back({held, track, held < kHeld});
    else  // torn: one part is an instance of its own, another one belongs to what stands beside
      held_.push_back({held - kSeenToo, track, true});
  }
  std::sort(held_.begin(), held_.end(),
            [](const Held& a, const Held& b) { return a.rank != b.rank ? a.rank > b.rank : a.track < b.track; });
}

/// Gives a track its share of an observation, whose shares begin at `first`, where it lies beside all other tracks. Two
/// that together are hardly larger than one object of their class are of one, but for people who were seen for long:
/// those pass each other at arm's length and remain two.
void Tracker::share(std::uint32_t i, const Held& held, std::size_t first)
{
  constexpr float kSideBySide = 0.4F;  // tracks that overlap by more are of one object
  constexpr float kMayBeTwo = 0.7F;    // times the usual size
  constexpr float kLongestM = 1.2F;    // length of a person
  constexpr std::uint32_t kKnown = 6;  // scans that make a track more than a fragment that happens to stay
  const ClassInfo& info = (*table_)[tracks_[held.track].object.class_index];
  const Extent& outline = expected_[held.track].outline;
  const bool is_person = info.length_m > 0.0F && info.length_m <= kLongestM;
  const bool is_known = is_person && !held.must_be_sure && tracks_[held.track].object.scans >= kKnown;
  bool is_sure = info.length_m > 0.0F || !held.must_be_sure;
  for (std::size_t s = first; s < shares_.size(); ++s)
  {
    Extent together = shares_[s].outline;
    const float overlap = leastOverlap(together, outline);
    if (is_known && shares_[s].is_known && overlap < 1.0F) continue;
    if (overlap >= kSideBySide) return;
    together.add(outline);
    if (info.length_m <= 0.0F) continue;
    if (together.fits(kMayBeTwo * info.length_m, kMayBeTwo * info.width_m)) return;
    is_sure = is_sure && !together.fits(kIsTwo * info.length_m, kIsTwo * info.width_m);
  }
  if (held.must_be_sure && (!is_sure || shares_.size() == first)) return;
  shares_.push_back({i, outline, is_sure, is_known});
}

void Tracker::shareOut(const Observations& observations, std::uint32_t i)
{
  findHeld(observations, i);
  if (held_.size() < 2) return;
  const std::size_t first = shares_.size();
  for (const Held& held : held_) share(i, held, first);
  if (shares_.size() == first + 1) shares_.pop_back();
}

const std::vector<Tracker::Share>& Tracker::findMerged(std::int64_t stamp_us, const Observations& observations)
{
  shares_.clear();
  match(stamp_us, observations);
  for (std::uint32_t i = 0; i < track_of_.size(); ++i) shareOut(observations, i);
  return shares_;
}
}  // namespace lidar_panoptic_clustering
