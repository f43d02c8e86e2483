#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace lidar_panoptic_clustering
{
/// Brings two streams of messages together by stamp, each stream in order but either one late or with gaps.
///
/// A message's partner is the waiting one nearest in time, at most `tolerance` away, the older of two equally near.
/// With a tolerance below half the streams' period there is only one. What can find no partner any more is dropped and
/// counted: what came before a match, and the oldest once `capacity` wait. Not shared between threads.
template <class Message>
class StampMatcher
{
public:
  using Pair = std::pair<Message, Message>;  ///< of the left and of the right stream

  /// `tolerance` in the stamps' unit.
  explicit StampMatcher(std::size_t capacity, std::uint64_t tolerance = 0) : capacity_(capacity), tolerance_(tolerance)
  {
  }

  std::optional<Pair> addLeft(std::uint64_t stamp, Message message)
  {
    auto partner = add(left_, right_, stamp, message);
    if (!partner) return std::nullopt;
    return Pair{std::move(message), std::move(*partner)};
  }
  std::optional<Pair> addRight(std::uint64_t stamp, Message message)
  {
    auto partner = add(right_, left_, stamp, message);
    if (!partner) return std::nullopt;
    return Pair{std::move(*partner), std::move(message)};
  }

  std::uint64_t unmatchedLeft() const { return left_.unmatched; }
  std::uint64_t unmatchedRight() const { return right_.unmatched; }
  std::size_t waitingLeft() const { return left_.waiting.size(); }

  /// Drops what waits, and counts from zero.
  void reset() { left_ = right_ = Side{}; }

private:
  struct Side
  {
    std::deque<std::pair<std::uint64_t, Message>> waiting;  ///< in order of arrival
    std::uint64_t unmatched = 0;

    void dropFirst(std::size_t count)
    {
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
      unmatched += count;
    }
  };

  std::optional<Message> add(Side& own, Side& other, std::uint64_t stamp, const Message& message)
  {
    const std::size_t nearest = findNearest(other, stamp);
    if (nearest == other.waiting.size())
    {
      own.waiting.emplace_back(stamp, message);
      if (own.waiting.size() > capacity_) own.dropFirst(1);
      return std::nullopt;
    }
    std::optional<Message> partner = std::move(other.waiting[nearest].second);
    other.dropFirst(nearest);
    other.waiting.pop_front();
    own.dropFirst(own.waiting.size());
    return partner;
  }

  /// The number of those that wait where none is near enough.
  std::size_t findNearest(const Side& side, std::uint64_t stamp) const
  {
    std::size_t nearest = side.waiting.size();
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < side.waiting.size(); ++i)
    {
      const std::uint64_t other = side.waiting[i].first, apart = other > stamp ? other - stamp : stamp - other;
      if (apart <= tolerance_ && apart < least) least = apart, nearest = i;
    }
    return nearest;
  }

  std::size_t capacity_;
  std::uint64_t tolerance_;
  Side left_, right_;
};
}  // namespace lidar_panoptic_clustering
