#include "ros/load_failure.h"

#include "ros/linking.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <atomic>
#include <list>
#include <mutex>

namespace lidar_panoptic_clustering
{
namespace
{
struct Announcement
{
  ros::NodeHandle nh;
  ros::Publisher publisher;
  diagnostic_msgs::DiagnosticArray message;
  std::atomic<int> left{10};
  ros::WallTimer timer;  // last: gone before what it uses

  void say()
  {
    message.header.stamp = ros::Time::now();
    publisher.publish(message);
    if (left == 1) timer.stop();
    --left;
  }
};

/// Those that have not said all, and some that have. They outlive the nodelet, and are gone with this library.
class Announcements
{
public:
  /// roscpp's own statics are made first, so that they are gone last.
  Announcements()
  {
    ros::NodeHandle().createWallTimer(ros::WallDuration(1.0), [](const ros::WallTimerEvent&) {});
  }

  Announcement& add()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    all_.remove_if([](const Announcement& announcement) { return announcement.left == 0; });
    return all_.emplace_back();
  }

private:
  std::mutex mutex_;
  std::list<Announcement> all_;
};
}  // namespace

void announceLoadFailure(const std::string& nodelet, const std::string& error)
{
  static Announcements announcements;
  Announcement& announcement = announcements.add();
  diagnostic_msgs::DiagnosticStatus status;
  status.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  status.name = nodelet.substr(nodelet.rfind('/', 0) == 0 ? 1 : 0) + ": load";
  status.message = "not loaded: " + error;
  announcement.message.status.push_back(status);
  announcement.publisher = advertiseAlone<diagnostic_msgs::DiagnosticArray>(announcement.nh, "/diagnostics", 10);
  announcement.timer = announcement.nh.createWallTimer(
      ros::WallDuration(1.0), [&announcement](const ros::WallTimerEvent&) { announcement.say(); });
}
}  // namespace lidar_panoptic_clustering
