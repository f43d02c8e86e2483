#include "ros/object_outputs.h"

#include "ros/detections.h"
#include "ros/linking.h"

namespace lidar_panoptic_clustering
{
bool ObjectOutputs::hasDetections()
{
  return detections::isBuilt();
}

void ObjectOutputs::advertise(ros::NodeHandle& nh, const ros::SubscriberStatusCallback& status)
{
  objects_ = advertiseAlone<ObjectArray>(nh, "objects", 1, status, status);
  detections_ = detections::advertise(nh, status);
}

void ObjectOutputs::shutdown()
{
  objects_.shutdown();
  detections_.shutdown();
}

void ObjectOutputs::publish(const ObjectArrayConstPtr& list)
{
  if (objects_.getNumSubscribers() > 0) objects_.publish(list);
  if (detections_.getNumSubscribers() > 0) detections::publish(detections_, *list);
}
}  // namespace lidar_panoptic_clustering
