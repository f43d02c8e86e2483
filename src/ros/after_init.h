#pragma once

#include <ros/node_handle.h>

#include <functional>

namespace lidar_panoptic_clustering
{
/// Calls what a nodelet has to do once its onInit() is over.
///
/// Nodelet 1.10.0 drops all that comes for a nodelet's queues during onInit(): a latched message of the same process,
/// which is there as soon as it is subscribed to, never came.
class AfterInit
{
public:
  /// The last step of onInit(). Calls at once, with nodelet 1.10.0 from the nodelet's queue a moment later.
  void start(ros::NodeHandle& nh, const std::function<void()>& call)
  {
#if defined(LIDAR_PANOPTIC_NODELET_DROPS) && LIDAR_PANOPTIC_NODELET_DROPS
    constexpr bool kOnce = true;
    timer_ = nh.createWallTimer(
        ros::WallDuration(0.1), [call](const ros::WallTimerEvent&) { call(); }, kOnce);
#else
    static_cast<void>(nh);
    call();
#endif
  }

  /// Waits for a call under way; none comes after it.
  void stop()
  {
    timer_.stop();
  }

private:
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering
