#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace lidar_panoptic_clustering
{
/// Holds the newest item for a worker thread: what comes while one waits there takes its place.
template <class T>
class Mailbox
{
public:
  /// Returns whether an item that nobody had taken was overwritten.
  bool put(T item)
  {
    std::optional<T> overwritten(std::move(item));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      std::swap(item_, overwritten);
    }
    arrived_.notify_one();
    return overwritten.has_value();  // freed out here, where nobody waits for it
  }

  /// Waits for an item. Nothing once the mailbox is closed.
  std::optional<T> take()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    arrived_.wait(lock, [this] { return item_.has_value() || closed_; });
    return closed_ ? std::nullopt : std::exchange(item_, std::nullopt);
  }

  /// Whether take() would not have to wait.
  bool hasNext()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return item_.has_value() || closed_;
  }

  void close()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closed_ = true;
    }
    arrived_.notify_all();
  }

private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<T> item_;
  bool closed_ = false;
};
}  // namespace lidar_panoptic_clustering
