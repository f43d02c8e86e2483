#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

namespace lidar_panoptic_clustering
{
/// A rectangle's sides [m], length >= width.
struct RectangleSize
{
  float length = 0.0F, width = 0.0F;  ///< [m], length >= width
};

/// A place in bird's-eye view [m].
struct PlanarPoint
{
  float x, y;  ///< [m], sensor frame
};

/// An object's outline in bird's-eye view: its farthest points in the eight directions 45 degrees apart.
///
/// The corners of any rectangle are among them, whatever its heading, so that sizes of box-like objects come out exact;
/// a circle's come out up to 8 % small. Constant size, and two outlines join without their points.
class Footprint
{
public:
  /// Widens the outline to hold a point [m].
  void add(float x, float y)
  {
    const float along[kAxes] = {x, y, x + y, x - y};
    if (isOutside(along)) extend(along, {x, y});  // hardly any point is: one branch instead of eight
  }

  /// Widens the outline to hold another one.
  void add(const Footprint& other)
  {
    if (!isOutside(other.max_) && !isOutside(other.min_)) return;
    for (const PlanarPoint& p : other.point_) add(p.x, p.y);
  }

  /// [m]
  float minX() const { return min_[0]; }
  /// [m]
  float maxX() const { return max_[0]; }
  /// [m]
  float minY() const { return min_[1]; }
  /// [m]
  float maxY() const { return max_[1]; }

  /// Whether the gap to another outline can be below `distance` [m]: false is certain, true is a guess from the extents
  /// along the four axes.
  bool mayBeCloser(const Footprint& other, float distance) const
  {
    constexpr float kSquareRoot2 = 1.41422F;  // the diagonals' unit is 1 / sqrt(2) m; rounded up
    for (int k = 0; k < kAxes; ++k)
    {
      const float reach = k < 2 ? distance : kSquareRoot2 * distance;
      if (min_[k] - other.max_[k] >= reach || other.min_[k] - max_[k] >= reach) return false;
    }
    return true;
  }

  /// Of the rectangle of least area about the outline. The footprint holds a point.
  RectangleSize smallestRectangle() const;

  /// Whether a rectangle about the outline is at most `length` x `width` [m].
  bool fits(float length, float width) const;
  /// The same about this outline and another one together.
  bool fitsWith(const Footprint& other, float length, float width) const;

  /// Nearest points of two outlines (convex polygons); where they overlap, the two are the same.
  struct Gap
  {
    PlanarPoint from, to;  ///< where the outlines are nearest: on this one, on the other
    /// [m^2]
    float squaredDistance() const { return (from.x - to.x) * (from.x - to.x) + (from.y - to.y) * (from.y - to.y); }
  };
  /// The shortest line to another outline; constant time.
  Gap gapTo(const Footprint& other) const;

  /// Whether the segment from a to b meets the outline.
  bool isCrossedBy(const PlanarPoint& a, const PlanarPoint& b) const;

  static constexpr int kAxes = 4;  ///< x, y and the two diagonals
  /// The distinct corners, counter-clockwise; returns how many.
  int corners(std::array<PlanarPoint, 2 * kAxes>& polygon) const;

private:
  friend class OrderedFootprint;
  static constexpr float kFar = std::numeric_limits<float>::infinity();

  bool isPoint() const { return min_[0] == max_[0] && min_[1] == max_[1]; }
  bool isBeside(const PlanarPoint& a, const PlanarPoint& b) const;

  bool isOutside(const float (&along)[kAxes]) const
  {
    using Floats = float __attribute__((vector_size(16)));
    Floats at, most, least;
    std::memcpy(&at, along, sizeof(at));
    std::memcpy(&most, max_, sizeof(most));
    std::memcpy(&least, min_, sizeof(least));
    const auto outside = (at > most) | (at < least);
    std::uint64_t halves[2];
    std::memcpy(halves, &outside, sizeof(halves));
    return (halves[0] | halves[1]) != 0;
  }

  void extend(const float (&along)[kAxes], const PlanarPoint& point)
  {
    for (int k = 0; k < kAxes; ++k)
    {
      if (along[k] > max_[k]) max_[k] = along[k], point_[k] = point;
      if (along[k] < min_[k]) min_[k] = along[k], point_[kAxes + k] = point;
    }
  }

  float max_[kAxes] = {-kFar, -kFar, -kFar, -kFar};
  float min_[kAxes] = {kFar, kFar, kFar, kFar};
  std::array<PlanarPoint, 2 * kAxes> point_{};  ///< farthest along each axis, then against it
};

/// An outline that knows which of its points came first, so that outlines of parts join to just the one that all their
/// points would have given one after the other: of two equally far the first.
class OrderedFootprint
{
public:
  /// Widens the outline to hold a point [m]; `order` rises from call to call.
  void add(float x, float y, std::uint32_t order);
  /// Widens the outline to hold another one, whose points may have come between its own.
  void add(const OrderedFootprint& other);
  /// The outline.
  const Footprint& outline() const { return outline_; }

private:
  static constexpr int kAxes = Footprint::kAxes;

  Footprint outline_;
  std::array<std::uint32_t, 2 * kAxes> order_{};  ///< parallel to Footprint::point_
};

inline void OrderedFootprint::add(float x, float y, std::uint32_t order)
{
  const float along[kAxes] = {x, y, x + y, x - y};
  if (!outline_.isOutside(along)) return;
  for (int k = 0; k < kAxes; ++k)
  {
    if (along[k] > outline_.max_[k]) order_[k] = order;
    if (along[k] < outline_.min_[k]) order_[kAxes + k] = order;
  }
  outline_.extend(along, {x, y});
}

inline void OrderedFootprint::add(const OrderedFootprint& other)
{
  const auto take = [&](int k) { outline_.point_[k] = other.outline_.point_[k], order_[k] = other.order_[k]; };
  for (int k = 0; k < kAxes; ++k)
  {
    const int against = kAxes + k;
    float &most = outline_.max_[k], &least = outline_.min_[k];
    const float their_most = other.outline_.max_[k], their_least = other.outline_.min_[k];
    if (their_most > most || (their_most == most && other.order_[k] < order_[k])) most = their_most, take(k);
    if (their_least < least || (their_least == least && other.order_[against] < order_[against]))
      least = their_least, take(against);
  }
}
}  // namespace lidar_panoptic_clustering
