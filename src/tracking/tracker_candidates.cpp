#include "lidar_panoptic_clustering/tracking/tracker.h"

#include "core/make_room.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = SparseAssignment::kNone;
constexpr float kCellM = 4.0F;
constexpr int kMostCells = 16;     ///< of an object along an axis; one of more than 64 m is no object
constexpr int kMostInACell = 128;  ///< tracks that are looked at; no real scene has as many on 16 square metres

/// What adds to the cost of a pair, the square of a distance in standard deviations. A few units are a doubt, ten are
/// as good as never.
constexpr double kOtherClass = 1.0, kOtherGroup = 5.0;  ///< a class that is not the track's
constexpr double kMissed = 5.0;                         ///< for each second the track was not seen
constexpr double kYoung = 4.0;                          ///< by the scans it was seen in: of two, the older one stays
constexpr double kMostHidden = 5.0;                     ///< for outlines of another size, which one stray point makes
constexpr double kMostPoints = 6.0;                     ///< for another number of points, as what is half hidden has

struct Cells
{
  std::int32_t first, last;
};

/// The cells from `low` to `high`, those in the middle where they are too many.
Cells cellsOf(float low, float high)
{
  const auto cell = [](float x)
  {
    constexpr float kFarthest = 1e6F;  // cells fit an int, and the index's bits
    return static_cast<std::int32_t>(std::floor(std::min(std::max(x, -kFarthest), kFarthest) / kCellM));
  };
  Cells cells{cell(low), cell(high)};
  if (cells.last - cells.first >= kMostCells)
  {
    cells.first = cell(0.5F * (low + high)) - kMostCells / 2;
    cells.last = cells.first + kMostCells - 1;
  }
  return cells;
}

template <class Visit>
void forEachCell(const Extent& extent, float margin_x, float margin_y, Visit visit)
{
  const Cells x = cellsOf(extent.min[0] - margin_x, extent.max[0] + margin_x);
  const Cells y = cellsOf(extent.min[1] - margin_y, extent.max[1] + margin_y);
  for (std::int32_t i = x.first; i <= x.last; ++i)
    for (std::int32_t j = y.first; j <= y.last; ++j) visit(VoxelKey{i, j, 0});
}
}  // namespace

/// Each track stands in all cells that its outline may reach, so that an observation looks into its own only.
void Tracker::enterIntoGrid()
{
  constexpr float kSigmas = 3.7F;  // the square is the dearest pair's cost
  grid_.reset(2 * tracks_.size());
  first_in_cell_.clear(), entries_.clear();
  for (std::uint32_t t = 0; t < tracks_.size(); ++t)
  {
    const double outline = prior_[tracks_[t].prior_class].outline_m;
    const auto margin = [&](std::size_t axis)
    { return kSigmas * static_cast<float>(std::sqrt(expected_[t].motion.variance(axis) + outline * outline)); };
    forEachCell(expected_[t].outline, margin(0), margin(1),
                [&](const VoxelKey& key)
                {
                  const std::uint32_t cell = grid_.insert(key);
                  if (cell == first_in_cell_.size()) first_in_cell_.push_back(kNone);
                  entries_.push_back({t, first_in_cell_[cell]});
                  first_in_cell_[cell] = static_cast<std::uint32_t>(entries_.size() - 1);
                });
  }
}

void Tracker::findCandidates(const Observations& observations)
{
  candidates_.clear(), candidates_begin_.clear();
  makeRoom(looked_at_, tracks_.size());
  looked_at_.assign(tracks_.size(), 0);
  for (std::uint32_t i = 0; i < observations.list.size(); ++i)
  {
    candidates_begin_.push_back(static_cast<std::uint32_t>(candidates_.size()));
    if (observations.list[i].point_count > 0) collect(observations.list[i], i + 1);
  }
  candidates_begin_.push_back(static_cast<std::uint32_t>(candidates_.size()));
}

void Tracker::collect(const Observation& observation, std::uint32_t number)
{
  forEachCell(observation.extent, 0.0F, 0.0F,
              [&](const VoxelKey& key)
              {
                const std::uint32_t cell = grid_.find(key);
                if (cell == VoxelIndex::kNone) return;
                int left = kMostInACell;
                for (std::uint32_t e = first_in_cell_[cell]; e != kNone && left > 0; e = entries_[e].next, --left)
                {
                  const std::uint32_t track = entries_[e].track;
                  if (std::exchange(looked_at_[track], number) == number) continue;
                  candidates_.push_back({track, costOf(observation, track)});
                }
              });
}

float Tracker::costOf(const Observation& observation, std::uint32_t track) const
{
  const Expected& expected = expected_[track];
  const MotionPrior& prior = prior_[tracks_[track].prior_class];
  const Displacement displacement = displacementOf(expected.outline, observation.extent);
  double moved = 0.0, hidden = 0.0;  // over four axes, which see two dimensions twice
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
  {
    const double shift = displacement.shift[k], doubt = displacement.doubt[k];
    moved += 0.5 * shift * shift / (expected.motion.variance(k) + prior.outline_m * prior.outline_m);
    hidden += 0.5 * doubt * doubt / (prior.occlusion_m * prior.occlusion_m);
  }
  return static_cast<float>(moved + std::min(hidden, kMostHidden) + penaltyOf(observation, track));
}

double Tracker::penaltyOf(const Observation& observation, std::uint32_t track) const
{
  constexpr double kPointsSigma = 0.8;  // of the logarithm of their ratio: a factor of 2.2
  constexpr double kFewPoints = 5.0;    // ratios of less are chance
  const TrackedObject& object = tracks_[track].object;
  const double last = tracks_[track].points, most = tracks_[track].most_points;
  const double usual = std::clamp<double>(observation.point_count, last, most);
  const double points = std::log((observation.point_count + kFewPoints) / (usual + kFewPoints)) / kPointsSigma;
  double penalty = std::min(points * points, kMostPoints);
  penalty += kMissed * 1e-6 * static_cast<double>(last_us_ - object.last_seen_us) + kYoung / object.scans;
  const ClassInfo &ours = (*table_)[object.class_index], &theirs = (*table_)[observation.class_index];
  if (&ours != &theirs) penalty += ours.group == theirs.group ? kOtherClass : kOtherGroup;
  return penalty;
}
}  // namespace lidar_panoptic_clustering
