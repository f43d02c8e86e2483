#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Where in a part, seen column by column, someone may stand: how high each of its columns goes.
///
/// A head and the shoulders under it stand above what is on both sides of them, a counter, a bench or nothing, by more
/// than the shoulders lie under the head. What hangs, as a pole across or a cable, is no side of a body and is not
/// looked at. No distance tells: who leans on a counter is as close to it as its own boards are to each other.
///
/// Linear in the returns and the columns between the outermost; keeps its memory.
class ColumnProfile
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;  ///< no cut

  /// Begins with a part that has a return in `column`, in an image of `columns`, the last of which is the first one's
  /// neighbour.
  void start(std::uint32_t columns, std::uint32_t column);
  /// A return, `height` above the ground [m].
  void add(std::uint32_t column, float height);
  /// Numbers the groups of neighbouring columns in which someone may stand, but for the whole of the part; returns how
  /// many there are.
  std::uint32_t find();
  /// Of a column of the part after find(): the number of its group, kNone for those without.
  std::uint32_t cutOf(std::uint32_t column) const { return cut_of_[placeOf(column)]; }

private:
  struct Extent
  {
    float top = -std::numeric_limits<float>::infinity(), bottom = std::numeric_limits<float>::infinity();
  };
  std::uint32_t placeOf(std::uint32_t column) const
  {
    return column >= origin_ ? column - origin_ : column + columns_ - origin_;
  }
  bool isSeen(std::uint32_t place) const { return extents_[place].top >= extents_[place].bottom; }
  void dropWhatHangs();
  void findAll();
  void take(std::uint32_t peak, std::uint32_t begin, std::uint32_t end);

  std::vector<Extent> extents_;        ///< by place: columns from half a turn before the first return's on
  std::vector<std::uint32_t> cut_of_;  ///< by place
  std::uint32_t columns_ = 0, origin_ = 0, begin_ = 0, end_ = 0, count_ = 0;
};
}  // namespace lidar_panoptic_clustering
