#include "lidar_panoptic_clustering/tracking/instance_parting.h"

#include "core/make_room.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using Point = Eigen::Vector2f;

constexpr std::uint32_t kFewestPoints = 20;  ///< of an instance that is cut
constexpr float kSmallestHalf = 0.25F;       ///< of its points

/// What may lie in the middle third of the way between two objects, of all that lies about the way; evenly spread
/// points give 0.21.
constexpr float kFewBetweenTracks = 0.107F, kFewBetweenHalves = 0.054F;

constexpr int kDirections = 8;  ///< in which an instance may be cut

Point direction(int turn)
{
  const float angle = 3.14159265F / kDirections * static_cast<float>(turn);
  return {std::cos(angle), std::sin(angle)};
}

Point middleOf(const Extent& extent)
{
  return {0.5F * (extent.min[0] + extent.max[0]), 0.5F * (extent.min[1] + extent.max[1])};
}
}  // namespace

InstanceParting::InstanceParting(std::shared_ptr<const ClassTable> table) : table_(std::move(table))
{
  if (!table_) throw std::invalid_argument("tracking needs a class table");
}

bool InstanceParting::isOversized(const Observation& observation) const
{
  if (observation.point_count < kFewestPoints) return false;
  const ClassInfo& info = (*table_)[observation.class_index];
  return isSmall(info) && !observation.extent.fits(info.length_m, info.width_m);
}

/// Whether it is of a class that stands upright, a person's, and as long as one with arms and legs apart.
bool InstanceParting::isLongBody(const Observation& observation) const
{
  constexpr float kLongestM = 1.2F, kLong = 0.8F;
  const ClassInfo& info = (*table_)[observation.class_index];
  if (info.length_m <= 0.0F || info.length_m > kLongestM) return false;
  float longest = 0.0F;
  for (std::size_t k = 0; k < Extent::kAxes; ++k)
    longest = std::max(longest, observation.extent.max[k] - observation.extent.min[k]);
  return longest > kLong * info.length_m;
}

bool InstanceParting::begin(const Observations& observations, const std::vector<Tracker::Share>& shares)
{
  observations_ = &observations, shares_ = &shares;
  begin_.assign(1, 0);
  std::size_t s = 0;
  for (std::uint32_t i = 0; i < observations.list.size(); ++i)
  {
    bool is_wanted = isOversized(observations.list[i]) || isLongBody(observations.list[i]);
    for (; s < shares.size() && shares[s].observation == i; ++s) is_wanted = true;
    begin_.push_back(begin_.back() + (is_wanted ? observations.list[i].point_count : 0));
  }
  makeRoom(filled_, begin_.size()), makeRoom(points_, begin_.back());
  filled_ = begin_;
  points_.resize(begin_.back());
  return !points_.empty();
}

const std::vector<Tracker::Share>& InstanceParting::finish()
{
  parts_.clear();
  std::size_t s = 0;
  for (std::uint32_t i = 0; i < observations_->list.size(); ++i)
  {
    const std::size_t first = s, before = parts_.size();
    while (s < shares_->size() && (*shares_)[s].observation == i) ++s;
    if (!wants(i)) continue;
    if (s > first) keepClear(i, first, s);
    if (parts_.size() == before && isLongBody(observations_->list[i])) cutAtHoles(i);
    if (parts_.size() == before && isOversized(observations_->list[i])) cut(i);
  }
  return parts_;
}

/// The one of shares `first` to `last` whose outline a point is in or nearest to.
std::size_t InstanceParting::nearestShare(const Point& point, std::size_t first, std::size_t last) const
{
  std::size_t nearest = first;
  float least = Extent::kFar;
  for (std::size_t s = first; s < last; ++s)
  {
    const float distance = (*shares_)[s].outline.distanceTo(point.x(), point.y());
    if (distance < least) least = distance, nearest = s;
  }
  return nearest;
}

/// Of shares `first` to `last` those that are clearly another object's than the ones before. Of three in a row the one
/// in the middle stands half way between the others: its points do not count there.
void InstanceParting::keepClear(std::uint32_t place, std::size_t first, std::size_t last)
{
  kept_.clear();
  for (std::size_t s = first; s < last; ++s)
  {
    const Tracker::Share& share = (*shares_)[s];
    const auto isClear = [&](std::size_t other)
    {
      const auto isTheirs = [&](const Point& point)
      {
        const std::size_t nearest = nearestShare(point, first, last);
        return nearest == s || nearest == other;
      };
      const Point from = middleOf((*shares_)[other].outline), to = middleOf(share.outline);
      return share.is_sure || shareHalfWay(place, from, to, isTheirs) <= kFewBetweenTracks;
    };
    if (std::all_of(kept_.begin(), kept_.end(), isClear)) kept_.push_back(s);
  }
  if (kept_.size() < 2) return;
  for (const std::size_t s : kept_) parts_.push_back((*shares_)[s]);
}

/// The share of the points about the way between two places that lies in the middle of it, of those that count.
template <class Counts>
float InstanceParting::shareHalfWay(std::uint32_t place, const Point& from, const Point& to, const Counts& counts) const
{
  constexpr float kBeyond = 0.2F, kMiddle = 0.15F;  // of the way
  const Point way = to - from;
  const float scale = 1.0F / std::max(way.squaredNorm(), 1e-6F);
  std::uint32_t about = 0, half_way = 0;
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
  {
    const float along = scale * way.dot(points_[k] - from);
    if (along < -kBeyond || along > 1.0F + kBeyond || !counts(points_[k])) continue;
    ++about;
    if (std::abs(along - 0.5F) < kMiddle) ++half_way;
  }
  return static_cast<float>(half_way) / static_cast<float>(std::max(about, 1U));
}

/// Parts an instance's points along an axis into two whose means lie farthest apart (two means); false where one is too
/// small. `from`, `to`: the means.
bool InstanceParting::findHalves(std::uint32_t place, const Point& axis, float& from, float& to) const
{
  constexpr int kTurns = 5;
  const auto count = static_cast<float>(filled_[place] - begin_[place]);
  from = Extent::kFar, to = -Extent::kFar;
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
  {
    const float along = axis.dot(points_[k]);
    from = std::min(from, along), to = std::max(to, along);
  }
  for (int turn = 0; turn < kTurns; ++turn)
  {
    const float middle = 0.5F * (from + to);
    float sum[2] = {0.0F, 0.0F}, points[2] = {0.0F, 0.0F};
    for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
    {
      const float along = axis.dot(points_[k]);
      const int half = along < middle ? 0 : 1;
      sum[half] += along, points[half] += 1.0F;
    }
    if (std::min(points[0], points[1]) < kSmallestHalf * count) return false;
    from = sum[0] / points[0], to = sum[1] / points[1];
  }
  return true;
}

void InstanceParting::sortAlong(std::uint32_t place, const Point& axis)
{
  along_.clear();
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k) along_.push_back(axis.dot(points_[k]));
  std::sort(along_.begin(), along_.end());
}

/// Cuts an instance wherever its points leave a hole in the one of eight directions in which the widest one is. A body
/// has none of that width; each piece has to have points enough for one.
void InstanceParting::cutAtHoles(std::uint32_t place)
{
  constexpr float kHoleM = 0.25F, kSmallestPiece = 0.12F;  // of its points
  constexpr std::uint32_t kFewest = 4;                     // points of a piece
  const std::uint32_t count = filled_[place] - begin_[place];
  const std::uint32_t least =
      std::max(kFewest, static_cast<std::uint32_t>(std::ceil(kSmallestPiece * static_cast<float>(count))));
  float widest = kHoleM;
  Point across = Point::Zero();
  for (int turn = 0; turn < kDirections; ++turn)
  {
    const Point axis = direction(turn);
    sortAlong(place, axis);
    for (std::uint32_t k = least; k + least <= count; ++k)
      if (const float hole = along_[k] - along_[k - 1]; hole > widest) widest = hole, across = axis;
  }
  if (across.isZero()) return;
  sortAlong(place, across);
  cuts_.clear();
  for (std::uint32_t k = least, from = 0; k + least <= count; ++k)
    if (k - from >= least && along_[k] - along_[k - 1] > kHoleM)
      cuts_.push_back(0.5F * (along_[k] + along_[k - 1])), from = k;
  const std::size_t first = parts_.size();
  parts_.resize(first + cuts_.size() + 1, {place, Extent(), true});
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
  {
    const auto piece = std::upper_bound(cuts_.begin(), cuts_.end(), across.dot(points_[k])) - cuts_.begin();
    parts_[first + static_cast<std::size_t>(piece)].outline.add(points_[k].x(), points_[k].y());
  }
}

/// Cuts an instance across the one of eight directions in which fewest points lie between the halves.
void InstanceParting::cut(std::uint32_t place)
{
  float least = kFewBetweenHalves, middle = 0.0F;
  Point across = Point::Zero();
  for (int turn = 0; turn < kDirections; ++turn)
  {
    const Point axis = direction(turn);
    float from = 0.0F, to = 0.0F;
    if (!findHalves(place, axis, from, to)) continue;
    const float between = shareHalfWay(place, from * axis, to * axis, [](const Point&) { return true; });
    if (between < least) least = between, middle = 0.5F * (from + to), across = axis;
  }
  if (across.isZero()) return;
  Extent halves[2];
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
    halves[across.dot(points_[k]) < middle ? 0 : 1].add(points_[k].x(), points_[k].y());
  for (const Extent& half : halves) parts_.push_back({place, half, true});
}
}  // namespace lidar_panoptic_clustering
