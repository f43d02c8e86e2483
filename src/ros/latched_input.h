#pragma once

#include <ros/node_handle.h>
#include <boost/shared_ptr.hpp>

#include <functional>
#include <utility>

namespace lidar_panoptic_clustering
{
/// Gives the last message of a latched topic again and again, once a second while nothing newer comes, so that those
/// who begin to listen to a nodelet's outputs later get its result too. The outputs need not be latched for it, and
/// nobody is given an old scan once the topic's publisher is gone.
///
/// Not shared between threads: all calls come from one callback queue that calls one callback at a time.
template <class Message>
class LatchedInput
{
public:
  using Ptr = boost::shared_ptr<const Message>;

  /// Calls `again` with the message while `is_published` holds. In wall time, for a clock may stand still.
  void start(ros::NodeHandle& nh, std::function<bool()> is_published, std::function<void(const Ptr&)> again)
  {
    is_published_ = std::move(is_published), again_ = std::move(again);
    timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { repeat(); });
  }

  /// Waits for a call under way; none comes after it.
  void stop() { timer_.stop(); }

  void received(const Ptr& message, bool latched)
  {
    message_ = latched ? message : nullptr;
    is_new_ = true;
  }

  void forget() { message_.reset(); }

  bool holds(const Ptr& message) const { return message_ == message; }

private:
  void repeat()
  {
    if (std::exchange(is_new_, false) || !message_) return;
    if (is_published_())
      again_(message_);
    else
      forget();
  }

  std::function<bool()> is_published_;
  std::function<void(const Ptr&)> again_;
  Ptr message_;
  bool is_new_ = false;  ///< came since the last round
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering
