#include "ros/detections.h"

#ifdef LIDAR_PANOPTIC_VISION_MSGS
#include "ros/linking.h"

#include <vision_msgs/Detection3DArray.h>
#include <boost/make_shared.hpp>

namespace lidar_panoptic_clustering::detections
{
namespace
{
vision_msgs::Detection3D toDetection(const Object& object, const std_msgs::Header& header)
{
  vision_msgs::Detection3D detection;
  detection.header = header;
  detection.bbox.center = object.pose;
  detection.bbox.size = object.size;
  detection.results.resize(1);
  auto& hypothesis = detection.results.front();
  hypothesis.id = object.class_id;
  hypothesis.score = object.class_share;
  hypothesis.pose.pose = object.pose;
  for (std::size_t row = 0; row < 3; ++row)  // of 6 x 6: position, then rotation
    for (std::size_t column = 0; column < 3; ++column)
      hypothesis.pose.covariance[6 * row + column] = object.position_covariance[3 * row + column];
  return detection;
}
}  // namespace

bool isBuilt()
{
  return true;
}

ros::Publisher advertise(ros::NodeHandle& nh, const ros::SubscriberStatusCallback& status)
{
  return advertiseAlone<vision_msgs::Detection3DArray>(nh, "detections", 1, status, status);
}

void publish(ros::Publisher& publisher, const ObjectArray& list)
{
  const auto array = boost::make_shared<vision_msgs::Detection3DArray>();
  array->header = list.header;
  array->detections.reserve(list.objects.size());
  for (const Object& object : list.objects)
    if (object.points > 0) array->detections.push_back(toDetection(object, list.header));
  publisher.publish(array);
}
}  // namespace lidar_panoptic_clustering::detections
#else
namespace lidar_panoptic_clustering::detections
{
bool isBuilt()
{
  return false;
}

ros::Publisher advertise(ros::NodeHandle&, const ros::SubscriberStatusCallback&)
{
  return {};
}

void publish(ros::Publisher&, const ObjectArray&) {}
}  // namespace lidar_panoptic_clustering::detections
#endif
