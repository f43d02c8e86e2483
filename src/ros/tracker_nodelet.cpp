#include "ros/tracker_nodelet.h"

#include "core/plain_numbers.h"
#include "ros/object_list.h"
#include "ros/parameter_server.h"

#include <pcl_conversions/pcl_conversions.h>
#include <boost/make_shared.hpp>

#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
template <class Matrix>
void setCovariance(const Matrix& from, Object::_velocity_covariance_type& to)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      to[static_cast<std::size_t>(3 * row + column)] = rounded(from(row, column));
}
}  // namespace

TrackerNodelet::Work TrackerNodelet::load()
{
  auto& nh = getPrivateNodeHandle();
  const std::vector<ParameterInfo> parameters = describeParameters(config_);
  diagnostics_.setWarning("parameters", warnOfUnusedParameters(nh, namesOf(parameters, {kClassTable})));
  applyParameters(config_, readParameters(nh, parameters));
  if (!config_.fixed_frame.empty() && config_.fixed_frame.front() == '/')
    throw std::invalid_argument("parameter " + nh.resolveName("fixed_frame") +
                                ": expected a name without a leading slash, got '" + config_.fixed_frame + "'");
  table_ = loadClassTable();
  tracker_ = std::make_unique<CloudTracker>(table_, config_.tracker);
  frame_.start(nh, config_.fixed_frame, config_.tf_wait_s);
  return [this](const Scan& scan) { process(scan); };
}

void TrackerNodelet::process(const Scan& scan)
{
  const ros::Time stamp = timeOf(scan);
  startAnewAfterJump(scan.cloud->header.frame_id, stamp);
  const Eigen::Isometry3d pose = poseOf(scan, stamp);
  const ros::WallTime start = ros::WallTime::now();
  const auto stamp_us = static_cast<std::int64_t>(stamp.toNSec() / 1000);
  PanopticCloud::Ptr out;
  if (wantsCloud())
  {
    out = pool_.take();
    tracker_->follow(*scan.cloud, stamp_us, pose, *out);
  }
  else
    tracker_->follow(*scan.cloud, stamp_us, pose);
  const double follow_ms = (ros::WallTime::now() - start).toSec() * 1e3;
  if (out) output_.publish(pcl::ros_ptr(out));
  if (wantsObjects()) publishObjects(*scan.cloud);
  warnOfUnknownClasses();
  diagnostics_.setFigure("live tracks", tracker_->liveTracks());
  diagnostics_.processed({{"track", follow_ms}});
}

ros::Time TrackerNodelet::timeOf(const Scan& scan)
{
  if (scan.cloud->header.stamp != 0)
  {
    warn("stamps", "");
    return pcl_conversions::fromPCL(scan.cloud->header.stamp);
  }
  warn("stamps", "clouds have a stamp of 0: taken for those of their arrival, which makes velocities uneven");
  return scan.time;
}

void TrackerNodelet::startAnewAfterJump(const std::string& frame, ros::Time stamp)
{
  const double back_s = (last_stamp_ - stamp).toSec();
  last_stamp_ = stamp;
  if (back_s <= 0.0) return;
  if (back_s <= config_.tracker.max_missed_s)
  {
    warn("order", "a scan came " + fixedText(back_s, 3) +
                      " s before the one that came first: it gets ids and teaches "
                      "nothing");
    return;
  }
  NODELET_WARN("time jumped back by %.3f s: tracks start anew", back_s);
  frame_.forgetFuture(frame, stamp);
  startAnew();
}

void TrackerNodelet::startAnew()
{
  tracker_->reset();
  marker_list_.reset();
}

Eigen::Isometry3d TrackerNodelet::poseOf(const Scan& scan, ros::Time stamp)
{
  const FixedFrame::Pose pose =
      frame_.find(scan.cloud->header.frame_id, stamp, scan.arrival, [this] { return hasNext(); });
  warn("tf", pose.doubt);
  // what was seen from the sensor has no place in the fixed frame
  if (std::exchange(has_pose_, pose.is_known) != pose.is_known) startAnew();
  return pose.fixed_from_sensor;
}

void TrackerNodelet::publishObjects(const PanopticCloud& cloud)
{
  const ObjectArrayPtr list = makeList(cloud);
  objects_.publish(list);
  if (wantsMarkers())
    markers_.publish(marker_list_.update(*list, tracker_->list(cloud), tracker_->pose(), ros::Time::now()));
}

ObjectArrayPtr TrackerNodelet::makeList(const PanopticCloud& cloud)
{
  const auto list = boost::make_shared<ObjectArray>();
  list->header = pcl_conversions::fromPCL(cloud.header);
  if (has_pose_) list->fixed_frame = config_.fixed_frame;
  list->class_table = table_->name();
  for (const ListedTrack& listed : tracker_->list(cloud))
  {
    list->objects.emplace_back();
    Object& object = list->objects.back();
    object.track_id = listed.object.track;
    object.instance_id = listed.instance;
    setClass(*table_, listed.object.class_index, object);
    object.class_share = rounded(static_cast<double>(listed.class_share));
    object.points = listed.point_count;
    setBox(listed.box, object);
    object.velocity.x = rounded(listed.velocity.x());
    object.velocity.y = rounded(listed.velocity.y());
    object.velocity.z = rounded(listed.velocity.z());
    setCovariance(listed.position_covariance, object.position_covariance);
    setCovariance(listed.velocity_covariance, object.velocity_covariance);
    object.since_first_seen = ros::Duration(listed.since_first_seen_s);
    object.since_last_seen = ros::Duration(listed.since_last_seen_s);
  }
  return list;
}

void TrackerNodelet::warnOfUnknownClasses()
{
  const std::size_t unknown = tracker_->unknownPoints();
  warn("classes", unknown == 0 ? ""
                               : "the class table '" + table_->name() +
                                     "' does not know the classes of all points of instances: is it the one they were "
                                     "clustered with?");
  if (unknown > 0) diagnostics_.setFigure("points of unknown classes", unknown);
}

void TrackerNodelet::warn(const char* subject, const std::string& doubt)
{
  std::string& warned = warned_[subject];
  if (doubt == warned) return;
  const bool is_new = warned.empty() && !doubt.empty();
  warned = doubt;
  diagnostics_.setWarning(subject, doubt);
  if (is_new) NODELET_WARN("%s", doubt.c_str());
}
}  // namespace lidar_panoptic_clustering
