#include "ros/load_failure.h"

#include "ros/linking.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <memory>

namespace lidar_panoptic_clustering
{
namespace
{
/// Lives on by the pointer in its own timer's callback, until it has said all.
struct Announcement : std::enable_shared_from_this<Announcement>
{
  ros::NodeHandle nh;
  ros::Publisher publisher;
  diagnostic_msgs::DiagnosticArray message;
  ros::WallTimer timer;
  int left = 10;

  void start()
  {
    timer = nh.createWallTimer(ros::WallDuration(1.0),
                               [self = shared_from_this()](const ros::WallTimerEvent&) { self->say(); });
  }

  void say()
  {
    message.header.stamp = ros::Time::now();
    publisher.publish(message);
    if (--left == 0) timer = ros::WallTimer();
  }
};
}  // namespace

void announceLoadFailure(const std::string& nodelet, const std::string& error)
{
  const auto announcement = std::make_shared<Announcement>();
  diagnostic_msgs::DiagnosticStatus status;
  status.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  status.name = nodelet.substr(nodelet.rfind('/', 0) == 0 ? 1 : 0) + ": load";
  status.message = "not loaded: " + error;
  announcement->message.status.push_back(status);
  announcement->publisher = advertiseAlone<diagnostic_msgs::DiagnosticArray>(announcement->nh, "/diagnostics", 10);
  announcement->start();
}
}  // namespace lidar_panoptic_clustering
