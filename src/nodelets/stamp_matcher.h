#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace lidar_panoptic_clustering
{
/// Brings two streams of messages together by stamp, each stream in order but either one late or with gaps.
///
/// What can find no partner any more is dropped and counted: what came before a match, and the oldest once `capacity`
/// wait. Not shared between threads.
template <class Message>
class StampMatcher
{
public:
  using Pair = std::pair<Message, Message>;  ///< of the left and of the right stream

  explicit StampMatcher(std::size_t capacity) : capacity_(capacity) {}

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
    for (std::size_t i = 0; i < other.waiting.size(); ++i)
    {
      if (other.waiting[i].first != stamp) continue;
      std::optional<Message> partner = std::move(other.waiting[i].second);
      other.dropFirst(i);
      other.waiting.pop_front();
      own.dropFirst(own.waiting.size());
      return partner;
    }
    own.waiting.emplace_back(stamp, message);
    if (own.waiting.size() > capacity_) own.dropFirst(1);
    return std::nullopt;
  }

  std::size_t capacity_;
  Side left_, right_;
};
}  // namespace lidar_panoptic_clustering
