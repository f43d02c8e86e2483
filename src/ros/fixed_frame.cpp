#include "ros/fixed_frame.h"

#include "core/plain_numbers.h"
#include "ros/linking.h"

#include <cmath>
#include <mutex>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPollS = 0.002;

Eigen::Isometry3d toPose(const geometry_msgs::TransformStamped& message)
{
  const auto& t = message.transform.translation;
  const auto& r = message.transform.rotation;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  return pose;
}

/// Old drivers still send frames with a slash before the name, which tf2 refuses.
std::string withoutSlash(const std::string& frame)
{
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}
}  // namespace

void FixedFrame::start(ros::NodeHandle& nh, const std::string& name, double wait_s)
{
  name_ = name, wait_s_ = wait_s;
  if (name_.empty()) return;
  const std::lock_guard<std::mutex> lock(linkMutex());
  buffer_ = std::make_unique<tf2_ros::Buffer>();
  listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_, nh, true);
}

void FixedFrame::forgetFuture(const std::string& sensor_frame, ros::Time stamp)
{
  const std::string frame = withoutSlash(sensor_frame);
  if (!buffer_ || frame.empty() || buffer_->canTransform(name_, frame, stamp)) return;
  buffer_->clear();
}

FixedFrame::Pose FixedFrame::find(const std::string& sensor_frame, ros::Time stamp, ros::WallTime arrival,
                                  const std::function<bool()>& is_overtaken)
{
  if (!buffer_) return {};
  const std::string frame = withoutSlash(sensor_frame);
  if (frame.empty()) return none(frame, "the cloud has no frame_id");
  try
  {
    if (!wait(frame, stamp, arrival, is_overtaken)) return latest(frame, stamp);
    waited_in_vain_ = false;
    return {toPose(buffer_->lookupTransform(name_, frame, stamp)), true, {}};
  }
  catch (const tf2::TransformException& error)
  {
    waited_in_vain_ = true;
    return none(frame, error.what());
  }
}

bool FixedFrame::wait(const std::string& frame, ros::Time stamp, ros::WallTime arrival,
                      const std::function<bool()>& is_overtaken)
{
  const ros::WallTime end = arrival + ros::WallDuration(wait_s_);
  while (!buffer_->canTransform(name_, frame, stamp))
  {
    if (ros::WallTime::now() >= end || is_overtaken()) return false;
    if (waited_in_vain_ && !buffer_->canTransform(name_, frame, ros::Time())) return false;
    ros::WallDuration(kPollS).sleep();  // in wall time, for a clock may stand still
  }
  return true;
}

FixedFrame::Pose FixedFrame::latest(const std::string& frame, ros::Time stamp) const
{
  const auto transform = buffer_->lookupTransform(name_, frame, ros::Time());
  const double behind = (stamp - transform.header.stamp).toSec();
  return {toPose(transform), true,
          "tf from " + name_ + " to " + frame + " is " + fixedText(std::abs(behind), 2) + " s " +
              (behind > 0.0 ? "behind" : "ahead of") +
              " the scan: by the latest there is, objects are as far off as the sensor has moved since"};
}

FixedFrame::Pose FixedFrame::none(const std::string& frame, const std::string& reason) const
{
  return {
      Eigen::Isometry3d::Identity(), false,
      "no tf from " + name_ + " to '" + frame + "' (" + reason +
          "): objects are followed as seen from the sensor; while that moves, velocities are relative to it and ids "
          "are lost sooner. Publish that transform or set fixed_frame"};
}
}  // namespace lidar_panoptic_clustering
