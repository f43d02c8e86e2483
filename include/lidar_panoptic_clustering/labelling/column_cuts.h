#pragma once

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
  /// Neighbouring columns, from `first` to before `first + count`, in a full turn beyond the last one too.
  struct Columns
  {
    std::uint32_t first, count;

    /// `columns`: of the image.
    bool holds(std::uint32_t column, std::uint32_t columns) const
    {
      const std::uint32_t beyond = column >= first ? column - first : column + columns - first;
      return beyond < count;
    }
  };

  /// Begins with a part that has a return in `column`, in an image of `columns`.
  void start(std::uint32_t columns, std::uint32_t column);
  /// A return, `height` above the ground [m].
  void add(std::uint32_t column, float height);
  /// Where someone may stand in it, but for the whole of it; valid until the next call.
  const std::vector<Columns>& find();

private:
  struct Extent
  {
    float top = -std::numeric_limits<float>::infinity(), bottom = std::numeric_limits<float>::infinity();
  };
  bool isSeen(std::uint32_t place) const { return extents_[place].top >= extents_[place].bottom; }
  void dropWhatHangs();
  void findAll();
  void take(std::uint32_t peak, std::uint32_t begin, std::uint32_t end);

  std::vector<Extent> extents_;  ///< by place: columns from half a turn before the first return's on
  std::uint32_t columns_ = 0, origin_ = 0, begin_ = 0, end_ = 0;
  std::vector<Columns> found_;
};
}  // namespace lidar_panoptic_clustering
