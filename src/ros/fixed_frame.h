#pragma once

#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>

#include <functional>
#include <memory>
#include <string>

namespace lidar_panoptic_clustering
{
/// Where the sensor is in a frame that stands still, by tf.
class FixedFrame
{
public:
  struct Pose
  {
    Eigen::Isometry3d fixed_from_sensor = Eigen::Isometry3d::Identity();
    bool is_known = false;  ///< otherwise objects are followed as seen from the sensor
    std::string doubt;      ///< what is missing and what it costs; empty: nothing
  };

  /// `name` of the frame; "" for none, and then nothing is listened to.
  void start(ros::NodeHandle& nh, const std::string& name, double wait_s);
  void stop() { listener_.reset(); }
  const std::string& name() const { return name_; }

  /// Waits for the transform of `stamp` for `wait_s` from `arrival`, or until `is_overtaken`, and takes the latest
  /// there is then. Where there has been none at all for one scan, the next ones do not wait. To be called by one
  /// thread.
  Pose find(const std::string& sensor_frame, ros::Time stamp, ros::WallTime arrival,
            const std::function<bool()>& is_overtaken);

  /// After time has jumped back: forgets transforms of a time that has not come yet any more, which would keep those of
  /// the present out. With use_sim_time tf does it by itself, and what it has got since is kept.
  void forgetFuture(const std::string& sensor_frame, ros::Time stamp);

private:
  bool wait(const std::string& frame, ros::Time stamp, ros::WallTime arrival,
            const std::function<bool()>& is_overtaken);
  Pose latest(const std::string& frame, ros::Time stamp) const;
  Pose none(const std::string& frame, const std::string& reason) const;

  std::string name_;
  double wait_s_ = 0.0;
  bool waited_in_vain_ = false;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};
}  // namespace lidar_panoptic_clustering
