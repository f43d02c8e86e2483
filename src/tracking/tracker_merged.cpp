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

/// Whether most of where a track should be lies within what was seen.
bool Tracker::isHeldBy(const Observation& observation, std::uint32_t track) const
{
  constexpr float kMost = 0.6F;
  const Extent& outline = expected_[track].outline;
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    const float shared =
        std::min(outline.max[k], observation.extent.max[k]) - std::max(outline.min[k], observation.extent.min[k]);
    if (shared < kMost * (outline.max[k] - outline.min[k])) return false;
  }
  return true;
}

const std::vector<Tracker::Share>& Tracker::findMerged(std::int64_t stamp_us, const Observations& observations)
{
  constexpr float kSideBySide = 0.4F;   // tracks that overlap by more are of one object
  constexpr std::uint32_t kFewest = 3;  // scans that make a track more than a fragment
  shares_.clear();
  match(stamp_us, observations);
  for (std::uint32_t i = 0; i < track_of_.size(); ++i)
  {
    if (track_of_[i] == kNone) continue;
    const std::size_t first = shares_.size();
    const auto share = [&](std::uint32_t track) { shares_.push_back({i, expected_[track].outline}); };
    share(track_of_[i]);
    for (std::uint32_t c = candidates_begin_[i]; c < candidates_begin_[i + 1]; ++c)
    {
      const std::uint32_t track = candidates_[c].track;
      if (observed_in_[track] != kNone || tracks_[track].object.scans < kFewest) continue;
      if (!isHeldBy(observations.list[i], track)) continue;
      const auto beside = [&](const Share& other)
      { return leastOverlap(other.outline, expected_[track].outline) < kSideBySide; };
      if (std::all_of(shares_.begin() + static_cast<std::ptrdiff_t>(first), shares_.end(), beside)) share(track);
    }
    if (shares_.size() == first + 1) shares_.pop_back();
  }
  return shares_;
}
}  // namespace lidar_panoptic_clustering
