#pragma once

#include "lidar_panoptic_clustering/projection/organized_scan.h"

#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A driver's cloud and what it was organised into.
struct OrganizedFrame
{
  std::uint64_t stamp = 0;   ///< [us]
  double organize_ms = 0.0;  ///< what the first step took
  sensor_msgs::PointCloud2ConstPtr message;
  OrganizedScan scan;
};

/// The last few frames by stamp, for instances that come back for them; their buffers are used again for later ones.
/// Not shared between threads.
class FrameHistory
{
public:
  using FramePtr = std::unique_ptr<OrganizedFrame>;

  explicit FrameHistory(std::size_t capacity) : capacity_(capacity) {}

  /// A frame to be filled.
  FramePtr make()
  {
    if (spare_.empty()) return std::make_unique<OrganizedFrame>();
    FramePtr frame = std::move(spare_.back());
    spare_.pop_back();
    return frame;
  }

  /// Keeps it, the oldest one no longer when there are too many.
  void keep(FramePtr frame)
  {
    kept_.push_back(std::move(frame));
    if (kept_.size() > capacity_) recycleFirst(1);
  }

  /// Gives back the buffers of a frame that is not kept (any more).
  void recycle(FramePtr frame)
  {
    frame->message.reset();
    spare_.push_back(std::move(frame));
  }

  /// The newest frame of that stamp, nullptr where there is none. Those before it are let go: clustering answers in
  /// order, and may have left some out.
  FramePtr take(std::uint64_t stamp)
  {
    const auto found = std::find_if(kept_.rbegin(), kept_.rend(), [&](const auto& f) { return f->stamp == stamp; });
    if (found == kept_.rend()) return nullptr;
    recycleFirst(static_cast<std::size_t>(kept_.rend() - found) - 1);
    FramePtr frame = std::move(kept_.front());
    kept_.pop_front();
    return frame;
  }

  /// Keeps a frame that was organised before its labels came, apart from the others; of these the newest `kept`.
  void keepEarly(FramePtr frame, std::size_t kept)
  {
    early_.push_back(std::move(frame));
    forgetEarly(kept);
  }
  void forgetEarly(std::size_t kept = 0)
  {
    for (; early_.size() > kept; early_.pop_front()) recycle(std::move(early_.front()));
  }
  /// The one of that message, those before it are let go; or a frame to be filled.
  FramePtr takeEarly(const sensor_msgs::PointCloud2ConstPtr& message)
  {
    const auto is_of = [&message](const FramePtr& frame) { return frame->message == message; };
    const auto found = std::find_if(early_.begin(), early_.end(), is_of);
    if (found == early_.end()) return make();
    forgetEarly(static_cast<std::size_t>(early_.end() - found));
    FramePtr frame = std::move(early_.front());
    early_.pop_front();
    return frame;
  }

  /// Frees all but one frame's buffers of those that are not early.
  void clear()
  {
    recycleFirst(kept_.size());
    if (spare_.size() > 1) spare_.resize(1);
  }

private:
  void recycleFirst(std::size_t count)
  {
    for (; count > 0; --count)
    {
      recycle(std::move(kept_.front()));
      kept_.pop_front();
    }
  }

  std::size_t capacity_;
  std::deque<FramePtr> kept_, early_;  ///< oldest first
  std::vector<FramePtr> spare_;
};
}  // namespace lidar_panoptic_clustering
