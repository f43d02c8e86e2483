#include "lidar_panoptic_clustering/tracking/instance_parting.h"

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

bool InstanceParting::begin(const Observations& observations, const std::vector<Tracker::Share>& shares)
{
  observations_ = &observations, shares_ = &shares;
  begin_.assign(1, 0);
  std::size_t s = 0;
  for (std::uint32_t i = 0; i < observations.list.size(); ++i)
  {
    bool is_wanted = isOversized(observations.list[i]);
    for (; s < shares.size() && shares[s].observation == i; ++s) is_wanted = true;
    begin_.push_back(begin_.back() + (is_wanted ? observations.list[i].point_count : 0));
  }
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
    if (parts_.size() == before && isOversized(observations_->list[i])) cut(i);
  }
  return parts_;
}

/// Of shares `first` to `last` those that are clearly another object's than the ones before.
void InstanceParting::keepClear(std::uint32_t place, std::size_t first, std::size_t last)
{
  const std::size_t before = parts_.size();
  for (std::size_t s = first; s < last; ++s)
  {
    const Tracker::Share& share = (*shares_)[s];
    const auto isClear = [&](const Tracker::Share& other) {
      return share.is_sure ||
             shareHalfWay(place, middleOf(other.outline), middleOf(share.outline)) <= kFewBetweenTracks;
    };
    if (std::all_of(parts_.begin() + static_cast<std::ptrdiff_t>(before), parts_.end(), isClear))
      parts_.push_back(share);
  }
  if (parts_.size() == before + 1) parts_.pop_back();
}

/// The share of the points about the way between two places that lies in the middle of it.
float InstanceParting::shareHalfWay(std::uint32_t place, const Point& from, const Point& to) const
{
  constexpr float kBeyond = 0.2F, kMiddle = 0.15F;  // of the way
  const Point way = to - from;
  const float scale = 1.0F / std::max(way.squaredNorm(), 1e-6F);
  std::uint32_t about = 0, half_way = 0;
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
  {
    const float along = scale * way.dot(points_[k] - from);
    if (along < -kBeyond || along > 1.0F + kBeyond) continue;
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

/// Cuts an instance across the one of eight directions in which fewest points lie between the halves.
void InstanceParting::cut(std::uint32_t place)
{
  constexpr int kDirections = 8;
  constexpr float kTurn = 3.14159265F / kDirections;
  float least = kFewBetweenHalves, middle = 0.0F;
  Point across = Point::Zero();
  for (int turn = 0; turn < kDirections; ++turn)
  {
    const float angle = kTurn * static_cast<float>(turn);
    const Point axis(std::cos(angle), std::sin(angle));
    float from = 0.0F, to = 0.0F;
    if (!findHalves(place, axis, from, to)) continue;
    const float between = shareHalfWay(place, from * axis, to * axis);
    if (between < least) least = between, middle = 0.5F * (from + to), across = axis;
  }
  if (across.isZero()) return;
  Extent halves[2];
  for (std::uint32_t k = begin_[place]; k < filled_[place]; ++k)
    halves[across.dot(points_[k]) < middle ? 0 : 1].add(points_[k].x(), points_[k].y());
  for (const Extent& half : halves) parts_.push_back({place, half, true});
}
}  // namespace lidar_panoptic_clustering
