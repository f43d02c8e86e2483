#include "lidar_panoptic_clustering/labelling/column_cuts.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kSitting = 1.2F;     // [m] the crown of someone who sits
constexpr float kShoulders = 0.45F;  // [m] under the crown: a head with its neck, 0.3, and shoulders fall by half of it
constexpr float kHead = 0.25F;       // [m] high; what of a column is less and hangs is no body
constexpr float kHangs = 1.1F;       // [m] what hides someone below is no higher: a counter
}  // namespace

void ColumnProfile::start(std::uint32_t columns, std::uint32_t column)
{
  columns_ = columns;
  extents_.resize(columns);
  cut_of_.resize(columns);
  const std::uint32_t half = columns / 2;
  origin_ = column >= half ? column - half : column + columns - half;
  begin_ = half, end_ = half;
}

void ColumnProfile::add(std::uint32_t column, float height)
{
  const std::uint32_t place = placeOf(column);
  begin_ = std::min(begin_, place), end_ = std::max(end_, place + 1);
  Extent& extent = extents_[place];
  extent.top = std::max(extent.top, height), extent.bottom = std::min(extent.bottom, height);
}

std::uint32_t ColumnProfile::find()
{
  count_ = 0;
  std::fill(cut_of_.begin() + begin_, cut_of_.begin() + end_, kNone);
  dropWhatHangs();
  findAll();
  std::fill(extents_.begin() + begin_, extents_.begin() + end_, Extent{});
  return count_;
}

/// Then they are as low as the ground.
void ColumnProfile::dropWhatHangs()
{
  for (std::uint32_t place = begin_; place < end_; ++place)
  {
    Extent& extent = extents_[place];
    if (isSeen(place) && extent.bottom > kHangs && extent.top - extent.bottom < kHead) extent = {0.0F, 0.0F};
  }
}

/// A peak ends where the columns are lower by more than its shoulders are.
void ColumnProfile::findAll()
{
  std::uint32_t begin = begin_, peak = begin_;
  for (std::uint32_t place = begin_; place < end_; ++place)
  {
    if (!isSeen(place)) continue;
    const float top = extents_[place].top, highest = extents_[peak].top;
    if (top < highest - kShoulders)
    {
      take(peak, begin, place);
      begin = peak = place;
    }
    else if (top > highest)
      peak = place;
  }
  take(peak, begin, end_);
}

/// `begin`: where the peak before it ended, so that each column is looked at twice.
void ColumnProfile::take(std::uint32_t peak, std::uint32_t begin, std::uint32_t end)
{
  if (!(extents_[peak].top > kSitting)) return;
  const auto is_lower = [&](std::uint32_t place) { return extents_[place].top < extents_[peak].top - kShoulders; };
  std::uint32_t first = peak;
  for (std::uint32_t place = peak; place > begin;)
  {
    --place;
    if (!isSeen(place)) continue;
    if (is_lower(place)) break;
    first = place;
  }
  const bool is_whole = first == begin_ && end == end_;
  if (is_whole || (first == begin && begin > begin_)) return;  // or as high as its neighbour's shoulder
  std::fill(cut_of_.begin() + first, cut_of_.begin() + end, count_++);
}
}  // namespace lidar_panoptic_clustering
