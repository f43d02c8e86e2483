#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/projection/raw_cloud.h"

#include <pcl_ros/point_cloud.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

#include <functional>
#include <string>

namespace lidar_panoptic_clustering
{
/// A view of the message; it must outlive the view.
RawCloud viewOf(const sensor_msgs::PointCloud2& message);

/// Turns the bytes of a serialised sensor_msgs/PointCloud2 into a cloud, header included (the stamp to PCL's
/// microsecond). The points are read where they lie, without a PointCloud2 in between. Throws std::exception's
/// descendants that say what was expected and what was found.
void readSerialized(std::uint8_t* bytes, std::uint32_t size, LabelledCloud& cloud);
void readSerialized(std::uint8_t* bytes, std::uint32_t size, PanopticCloud& cloud);

template <class Cloud>
using CloudCallback = std::function<void(const boost::shared_ptr<const Cloud>&)>;
using CloudErrorCallback = std::function<void(const std::string& message)>;

namespace detail
{
/// Marks the pointer to an empty cloud that stands for a refused message: it rides along as the pointer's deleter.
struct Refusal
{
  std::string reason;

  template <class Cloud>
  void operator()(Cloud* cloud) const
  {
    delete cloud;
  }
};

/// Reads clouds from the wire field by field, in place of pcl_ros, whose mapping of fields is built from the first
/// message of the process and applied unchecked to all later ones.
///
/// roscpp deserialises a message once for all subscribers of one C++ type, with the helper of the first of them, which
/// may be gone by then. So deserialize() touches no state, and the refusal travels to every subscriber's own call().
template <class Cloud>
class CheckedCallbackHelper : public ros::SubscriptionCallbackHelperT<const boost::shared_ptr<const Cloud>&>
{
  using Base = ros::SubscriptionCallbackHelperT<const boost::shared_ptr<const Cloud>&>;

public:
  CheckedCallbackHelper(std::string topic, const CloudCallback<Cloud>& callback, CloudErrorCallback on_error)
      : Base(callback), topic_(std::move(topic)), on_error_(std::move(on_error))
  {
  }

  ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& params) override
  {
    try
    {
      const auto cloud = boost::make_shared<Cloud>();
      readSerialized(params.buffer, params.length, *cloud);
      return cloud;
    }
    catch (const std::exception& error)
    {
      return boost::shared_ptr<Cloud>(new Cloud, Refusal{error.what()});
    }
  }

  void call(ros::SubscriptionCallbackHelperCallParams& params) override
  {
    if (const auto* refusal = boost::get_deleter<Refusal>(params.event.getConstMessage()))
      on_error_("cloud on " + topic_ + " from " + params.event.getPublisherName() + " dropped: " + refusal->reason);
    else
      Base::call(params);
  }

private:
  std::string topic_;
  CloudErrorCallback on_error_;
};
}  // namespace detail

/// Subscribes to clouds of `Cloud` (LabelledCloud or PanopticCloud), each message from the wire checked by itself.
///
/// A publisher of the same C++ type in this process hands over its very pointer, unchecked. All else (another process,
/// a bag, a publisher of sensor_msgs::PointCloud2 in this process) is serialised and read by readSerialized(): any
/// field types, order, packing and row padding; a cloud that cannot be read is dropped and `on_error` gets a message
/// with topic, sender, expected and found. `on_error` runs where `callback` would have run: in the callback queue's
/// thread, never in a transport thread, not beside `callback`, and not after the subscriber was shut down.
///
/// `queue` is the callback queue; nullptr stands for the node handle's.
template <class Cloud>
ros::Subscriber subscribeChecked(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                                 const CloudCallback<Cloud>& callback, const CloudErrorCallback& on_error,
                                 ros::CallbackQueueInterface* queue = nullptr)
{
  ros::SubscribeOptions options;
  options.topic = topic;
  options.queue_size = queue_size;
  options.md5sum = ros::message_traits::md5sum<Cloud>();
  options.datatype = ros::message_traits::datatype<Cloud>();
  options.helper = boost::make_shared<detail::CheckedCallbackHelper<Cloud>>(nh.resolveName(topic), callback, on_error);
  options.callback_queue = queue;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return nh.subscribe(options);
}
}  // namespace lidar_panoptic_clustering
