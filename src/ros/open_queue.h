#pragma once

#include <ros/node_handle.h>

namespace lidar_panoptic_clustering
{
/// To be called first in onInit(), for one handle of each of the nodelet's queues that it uses.
///
/// Nodelet 1.10.0 keeps the queues shut during onInit() and throws away what comes for them: a latched message of the
/// same process, which is there as soon as it is subscribed to, who listens already, a service's call, and a timer's
/// first round, after which it never comes again. Other releases never shut them; there it changes nothing.
void openQueue(const ros::NodeHandle& nh);
}  // namespace lidar_panoptic_clustering
