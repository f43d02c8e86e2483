#pragma once

#include <ros/node_handle.h>

#include <mutex>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
/// To be held around everything that advertises or subscribes in a nodelet.
///
/// Where one thread of a process advertises a topic while another subscribes to it, roscpp may link the two twice, and
/// every message comes twice: TopicManager::advertise() enters the publication first and looks for subscribers of the
/// process afterwards, so that a subscriber that comes in between is linked by both. One lock for the process prevents
/// it among the nodelets of this package; others know nothing of it.
std::mutex& linkMutex();

/// NodeHandle::advertise() under linkMutex().
template <class Message, class... Arguments>
ros::Publisher advertiseAlone(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                              Arguments&&... arguments)
{
  const std::lock_guard<std::mutex> lock(linkMutex());
  return nh.advertise<Message>(topic, queue_size, std::forward<Arguments>(arguments)...);
}

/// NodeHandle::subscribe() under linkMutex().
inline ros::Subscriber subscribeAlone(ros::NodeHandle& nh, ros::SubscribeOptions& options)
{
  const std::lock_guard<std::mutex> lock(linkMutex());
  return nh.subscribe(options);
}
}  // namespace lidar_panoptic_clustering
