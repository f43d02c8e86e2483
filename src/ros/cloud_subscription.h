#pragma once

#include "ros/linking.h"
#include "ros/message_reading.h"

#include <ros/ros.h>

#include <functional>
#include <string>
#include <typeinfo>
#include <utility>

namespace lidar_panoptic_clustering
{
/// How a message came.
struct Arrival
{
  bool latched = false;     ///< its publisher keeps it for those who come later
  bool by_pointer = false;  ///< the publisher's own object, not read from bytes
  std::string sender;       ///< the publisher's node
};

/// For /diagnostics: "by pointer from /driver, latched".
inline std::string describe(const Arrival& arrival)
{
  return (arrival.by_pointer ? "by pointer from " : "as bytes from ") + arrival.sender +
         (arrival.latched ? ", latched" : "");
}

template <class Message>
using MessageCallback = std::function<void(const boost::shared_ptr<const Message>&)>;
template <class Message>
using ArrivalCallback = std::function<void(const boost::shared_ptr<const Message>&, const Arrival&)>;
using MessageErrorCallback = std::function<void(const std::string& message)>;

namespace detail
{
/// Marks the pointer to a message that was read from bytes: it rides along as the pointer's deleter.
struct FromBytes
{
  std::string refusal;  ///< why the message could not be read; it is an empty one then

  template <class Message>
  void operator()(Message* message) const
  {
    delete message;
  }
};

/// Reads messages from the wire by readSerialized(), which checks them; for clouds in place of pcl_ros, whose mapping
/// of fields is built from the first message of the process and applied unchecked to all later ones.
///
/// roscpp deserialises a message once for all subscribers of one C++ type, with the helper of the first of them, which
/// may be gone by then; and where a helper throws or returns nothing, roscpp frees the bytes and has the next
/// subscriber read them again. So deserialize() touches no state, always returns a message, and the refusal travels
/// with that to every subscriber's own call().
template <class Message>
class CheckedCallbackHelper : public ros::SubscriptionCallbackHelper
{
public:
  CheckedCallbackHelper(std::string topic, ArrivalCallback<Message> callback, MessageErrorCallback on_error)
      : topic_(std::move(topic)), callback_(std::move(callback)), on_error_(std::move(on_error))
  {
  }

  const std::type_info& getTypeInfo() override { return typeid(Message); }
  bool isConst() override { return true; }
  bool hasHeader() override { return ros::message_traits::hasHeader<Message>(); }

  ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& params) override
  {
    try
    {
      boost::shared_ptr<Message> message(new Message, FromBytes{});
      readSerialized(params.buffer, params.length, *message);
      return message;
    }
    catch (const std::exception& error)
    {
      return boost::shared_ptr<Message>(new Message, FromBytes{error.what()});
    }
  }

  void call(ros::SubscriptionCallbackHelperCallParams& params) override
  {
    const auto message = boost::static_pointer_cast<const Message>(params.event.getConstMessage());
    if (!message) return;  // another's helper of the same type could not read it
    const auto* from_bytes = boost::get_deleter<FromBytes>(message);
    if (from_bytes != nullptr && !from_bytes->refusal.empty())
      return on_error_(std::string(kMessageNoun<Message>) + " on " + topic_ + " from " +
                       params.event.getPublisherName() + " dropped: " + from_bytes->refusal);
    Arrival arrival;
    arrival.sender = params.event.getPublisherName();
    arrival.by_pointer = from_bytes == nullptr && arrival.sender == ros::this_node::getName();
    arrival.latched = isLatched(params.event.getConnectionHeader());
    callback_(message, arrival);
  }

private:
  static bool isLatched(const ros::M_string& connection)
  {
    const auto entry = connection.find("latching");
    return entry != connection.end() && entry->second == "1";
  }

  std::string topic_;
  ArrivalCallback<Message> callback_;
  MessageErrorCallback on_error_;
};
}  // namespace detail

/// Subscribes to messages of a type that readSerialized() knows, each message from the wire checked by itself.
///
/// A publisher of the same C++ type in this process hands over its very pointer, unchecked. All else (another process,
/// a bag, a publisher of sensor_msgs::PointCloud2 in this process to a subscriber of PCL clouds) is serialised and read
/// by readSerialized(): clouds of any field types, order, packing and row padding; what cannot be read is dropped and
/// `on_error` gets a message with topic, sender, expected and found. `on_error` runs where `callback` would have run:
/// in the callback queue's thread, never in a transport thread, not beside `callback`, and not after the subscriber was
/// shut down. A subscriber of the same C++ type that somebody else's nodelet has put on the topic before reads the
/// message for all, in its own way.
///
/// `queue` is the callback queue; nullptr stands for the node handle's.
template <class Message>
ros::Subscriber subscribeChecked(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                                 const ArrivalCallback<Message>& callback, const MessageErrorCallback& on_error,
                                 ros::CallbackQueueInterface* queue = nullptr)
{
  ros::SubscribeOptions options;
  options.topic = topic;
  options.queue_size = queue_size;
  options.md5sum = ros::message_traits::md5sum<Message>();
  options.datatype = ros::message_traits::datatype<Message>();
  options.helper =
      boost::make_shared<detail::CheckedCallbackHelper<Message>>(nh.resolveName(topic), callback, on_error);
  options.callback_queue = queue;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return subscribeAlone(nh, options);
}

/// The same for a callback that does not ask how a message came.
template <class Message>
ros::Subscriber subscribeChecked(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                                 const MessageCallback<Message>& callback, const MessageErrorCallback& on_error,
                                 ros::CallbackQueueInterface* queue = nullptr)
{
  const ArrivalCallback<Message> any_arrival = [callback](const boost::shared_ptr<const Message>& message,
                                                          const Arrival&) { callback(message); };
  return subscribeChecked<Message>(nh, topic, queue_size, any_arrival, on_error, queue);
}
}  // namespace lidar_panoptic_clustering
