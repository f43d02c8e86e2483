#include "lidar_panoptic_clustering/tracking/tracker.h"

#include "core/make_room.h"
#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = SparseAssignment::kNone;

TrackerConfig validated(const TrackerConfig& config)
{
  validateParameters(config);
  return config;
}

Extent shifted(const Extent& extent, double x, double y)
{
  constexpr double kHalfRoot = 0.70710678118654752;
  const double by[Extent::kAxes] = {x, y, kHalfRoot * (x + y), kHalfRoot * (x - y)};
  Extent result;
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    result.min[k] = static_cast<float>(extent.min[k] + by[k]);
    result.max[k] = static_cast<float>(extent.max[k] + by[k]);
  }
  return result;
}

double seconds(std::int64_t us)
{
  return static_cast<double>(us) * 1e-6;
}
}  // namespace

Tracker::Tracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config)
    : table_(std::move(table)), config_(validated(config))
{
  if (!table_) throw std::invalid_argument("tracking needs a class table");
  for (std::size_t c = 0; c < table_->size(); ++c)
    prior_.push_back(MotionPrior::of((*table_)[static_cast<ClassIndex>(c)]));
}

void Tracker::configure(const TrackerConfig& config)
{
  config_ = validated(config);
}

void Tracker::reset()
{
  tracks_.clear(), votes_.clear();
  has_begun_ = false;
}

void Tracker::restart()
{
  reset();
  next_id_ = 1;
}

bool Tracker::isAlive(std::uint32_t track) const
{
  const auto at = std::lower_bound(tracks_.begin(), tracks_.end(), track,
                                   [](const Track& t, std::uint32_t id) { return t.object.track < id; });
  return at != tracks_.end() && at->object.track == track && !at->has_ended;
}

const std::vector<TrackedObject>& Tracker::update(std::int64_t stamp_us, const Observations& observations)
{
  match(stamp_us, observations);
  return updateMatched(stamp_us, observations);
}

const std::vector<TrackedObject>& Tracker::updateMatched(std::int64_t stamp_us, const Observations& observations)
{
  joinParts(observations);
  const bool is_new = !has_begun_ || stamp_us > last_us_;
  if (is_new) learn(stamp_us, observations);
  giveIds(stamp_us, observations, is_new);
  if (is_new) last_us_ = stamp_us, has_begun_ = true;
  return objects_;
}

void Tracker::match(std::int64_t stamp_us, const Observations& observations)
{
  if (has_begun_ && seconds(last_us_ - stamp_us) > config_.max_missed_s) reset();
  dropLost(stamp_us);
  expect(has_begun_ ? seconds(stamp_us - last_us_) : 0.0, observations.origin);
  enterIntoGrid();
  findCandidates(observations);
  assign(observations);
}

void Tracker::dropLost(std::int64_t stamp_us)
{
  const std::size_t classes = table_->size();
  std::size_t kept = 0;
  for (std::size_t t = 0; t < tracks_.size(); ++t)
  {
    if (tracks_[t].has_ended || seconds(stamp_us - tracks_[t].object.last_seen_us) > config_.max_missed_s) continue;
    if (kept != t)
    {
      tracks_[kept] = tracks_[t];
      std::copy_n(votes_.begin() + static_cast<std::ptrdiff_t>(t * classes), classes,
                  votes_.begin() + static_cast<std::ptrdiff_t>(kept * classes));
    }
    ++kept;
  }
  tracks_.resize(kept), votes_.resize(kept * classes);
}

void Tracker::expect(double dt, const Eigen::Vector3d& origin)
{
  expected_.resize(tracks_.size());
  for (std::size_t t = 0; t < tracks_.size(); ++t)
  {
    Expected& expected = expected_[t];
    expected.motion = tracks_[t].motion;
    expected.motion.predict(dt, prior_[tracks_[t].prior_class]);
    expected.outline =
        shifted(tracks_[t].outline, expected.motion.mean.x() - origin.x(), expected.motion.mean.y() - origin.y());
  }
}

/// How sure the edges of an outline are: beams lie farther apart far out.
double Tracker::noiseOf(const Observation& observation) const
{
  return 0.03 + 0.001 * static_cast<double>(std::hypot(observation.x, observation.y));
}

void Tracker::assign(const Observations& observations)
{
  assignment_.reset(tracks_.size());
  for (std::size_t i = 0; i < observations.list.size(); ++i)
  {
    // a large object's match says more than a fragment's: its points are as many measurements
    const float weight =
        std::clamp(std::sqrt(0.1F * static_cast<float>(observations.list[i].point_count)), 1.0F, 30.0F);
    assignment_.addRow(weight * kDearest);
    for (std::uint32_t c = candidates_begin_[i]; c < candidates_begin_[i + 1]; ++c)
      if (candidates_[c].cost < kDearest) assignment_.addPair(candidates_[c].track, weight * candidates_[c].cost);
  }
  makeRoom(track_of_, observations.list.size());
  track_of_ = assignment_.solve();
  makeRoom(observed_in_, tracks_.size());
  observed_in_.assign(tracks_.size(), kNone);
  for (std::uint32_t i = 0; i < track_of_.size(); ++i)
    if (track_of_[i] != kNone) observed_in_[track_of_[i]] = i;
}

void Tracker::learn(std::int64_t stamp_us, const Observations& observations)
{
  for (std::uint32_t t = 0; t < tracks_.size(); ++t)
  {
    Track& track = tracks_[t];
    if (observed_in_[t] == kNone)
    {
      track.motion = expected_[t].motion;
      continue;
    }
    follow(track, expected_[t], whole_[t], observations.origin);
    ++track.object.scans;
    track.object.last_seen_us = stamp_us;
  }
  for (std::uint32_t i = 0; i < track_of_.size(); ++i)
    if (track_of_[i] != kNone) vote(track_of_[i], observations.list[i]);
  for (const std::uint32_t t : ended_) tracks_[t].has_ended = true;
}

void Tracker::tellMotion(Track& track)
{
  track.object.position = track.motion.mean.head<2>();
  track.object.position_covariance = track.motion.covariance.topLeftCorner<2, 2>();
  track.object.velocity = track.motion.mean.tail<2>();
  track.object.velocity_covariance = track.motion.covariance.bottomRightCorner<2, 2>();
}

void Tracker::follow(Track& track, const Expected& expected, const Observation& seen, const Eigen::Vector3d& origin)
{
  constexpr float kForget = 0.3F;       // of what was there and is not seen
  constexpr float kKeepPoints = 0.85F;  // a scan; half of them are forgotten in as long as a pole or a person hides
  track.points = static_cast<float>(seen.point_count);
  track.most_points = std::max(track.points, kKeepPoints * track.most_points);
  track.motion = expected.motion;
  track.motion.correct(displacementOf(expected.outline, seen.extent), noiseOf(seen));
  tellMotion(track);
  const Extent now = shifted(seen.extent, origin.x() - track.motion.mean.x(), origin.y() - track.motion.mean.y());
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    float &min = track.outline.min[k], &max = track.outline.max[k];
    min = std::min(now.min[k], min + kForget * (now.min[k] - min));
    max = std::max(now.max[k], max + kForget * (now.max[k] - max));
  }
}

void Tracker::vote(std::uint32_t track, const Observation& observation)
{
  float* votes = votes_.data() + track * table_->size();
  votes[observation.class_index] += std::sqrt(static_cast<float>(observation.point_count));
  ClassIndex& winner = tracks_[track].object.class_index;
  const auto most = std::max_element(votes, votes + table_->size()) - votes;
  if (votes[most] > votes[winner]) winner = static_cast<ClassIndex>(most);
  tracks_[track].prior_class = winner;
}

/// Whether a track's votes are clearly against the class that a scan gives it. Where they are few or about even, either
/// may be right, and to change the scan's own class would gain nothing.
bool Tracker::isOverruled(std::uint32_t track, ClassIndex seen) const
{
  constexpr std::uint32_t kFewest = 5;  // scans that make a vote: half a second
  constexpr float kClearly = 2.0F;      // two thirds of the votes
  if (track == kNone || tracks_[track].object.scans < kFewest) return false;
  const float* votes = votes_.data() + track * table_->size();
  return votes[tracks_[track].object.class_index] >= kClearly * votes[seen];
}

std::uint32_t Tracker::bear(std::int64_t stamp_us, const Observation& observation, const Eigen::Vector3d& origin)
{
  Track track;
  track.object.class_index = observation.class_index;
  track.object.track = next_id_++;
  track.object.first_seen_us = track.object.last_seen_us = stamp_us;
  track.object.scans = 1;
  track.points = track.most_points = static_cast<float>(observation.point_count);
  track.prior_class = observation.class_index;
  const double x = origin.x() + static_cast<double>(observation.x), y = origin.y() + static_cast<double>(observation.y);
  track.motion = MotionState::at(x, y, noiseOf(observation), prior_[observation.class_index]);
  tellMotion(track);
  track.outline = shifted(observation.extent, origin.x() - x, origin.y() - y);
  tracks_.push_back(track);
  votes_.resize(votes_.size() + table_->size(), 0.0F);
  const auto place = static_cast<std::uint32_t>(tracks_.size() - 1);
  vote(place, observation);
  return place;
}

void Tracker::giveIds(std::int64_t stamp_us, const Observations& observations, bool is_new)
{
  objects_.resize(observations.list.size());
  for (std::uint32_t i = 0; i < observations.list.size(); ++i)
  {
    const Observation& observation = observations.list[i];
    if (track_of_[i] == kNone && is_new && observation.point_count > 0)
      track_of_[i] = bear(stamp_us, observation, observations.origin);
    TrackedObject& object = objects_[i];
    if (track_of_[i] != kNone)
      object = tracks_[track_of_[i]].object;
    else
    {
      object = TrackedObject();
      object.track = next_id_++;
      object.class_index = observation.class_index;
      object.first_seen_us = object.last_seen_us = stamp_us;
      object.scans = 1;
    }
    if (!config_.vote_over_time || !isOverruled(track_of_[i], observation.class_index))
      object.class_index = observation.class_index;
  }
}
}  // namespace lidar_panoptic_clustering
