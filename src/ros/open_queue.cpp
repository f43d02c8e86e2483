#include "ros/open_queue.h"

#include <nodelet/detail/callback_queue.h>

namespace lidar_panoptic_clustering
{
namespace
{
template <class Queue>
auto enable(Queue& queue, int) -> decltype(queue.enable())
{
  queue.enable();
}

/// Queues of releases before 1.10.0, which cannot be shut.
template <class Queue>
void enable(Queue&, long)
{
}
}  // namespace

void openQueue(const ros::NodeHandle& nh)
{
  auto* const queue = dynamic_cast<nodelet::detail::CallbackQueue*>(nh.getCallbackQueue());
  if (queue != nullptr) enable(*queue, 0);
}
}  // namespace lidar_panoptic_clustering
