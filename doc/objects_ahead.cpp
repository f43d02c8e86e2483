// Says what is ahead in our lane: ~objects is a tracker's list.
#include <lidar_panoptic_clustering/ObjectArray.h>
#include <ros/ros.h>
int main(int argc, char** argv)
{
  ros::init(argc, argv, "objects_ahead");
  const boost::function<void(const lidar_panoptic_clustering::ObjectArrayConstPtr&)> look = [](const auto& scan) {
    for (const auto& o : scan->objects)
      if (o.pose.position.x > 2.0 && std::abs(o.pose.position.y) < 1.5)
        ROS_INFO("%s #%u %.1f m ahead, %.1f m/s", o.class_name.c_str(), o.track_id, o.pose.position.x, o.velocity.x);
  };
  const ros::Subscriber subscriber = ros::NodeHandle("~").subscribe("objects", 1, look);
  ros::spin();
}
