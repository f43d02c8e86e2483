#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

#include <atomic>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Waits until `condition` holds; false after 30 s, which is long for sanitizers on a busy machine.
template <class Condition>
bool eventually(Condition condition)
{
  const auto end = ros::WallTime::now() + ros::WallDuration(30.0);
  while (!condition())
  {
    if (ros::WallTime::now() > end) return false;
    ros::WallDuration(0.005).sleep();
  }
  return true;
}

/// Subscribes to a topic and keeps what comes, in order.
template <class Message>
class Probe
{
public:
  using Ptr = boost::shared_ptr<const Message>;

  explicit Probe(const std::string& topic)
  {
    const boost::function<void(const Ptr&)> keep = [this](const Ptr& message)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      messages_.push_back(message);
    };
    subscriber_ = ros::NodeHandle().subscribe<Message>(topic, 1000, keep);
  }

  /// The oldest message not yet taken; null when none comes.
  Ptr next()
  {
    Ptr message;
    eventually([&] { return (message = takeIfThere()) != nullptr; });
    return message;
  }

  Ptr takeIfThere()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (messages_.empty()) return nullptr;
    const Ptr message = messages_.front();
    messages_.pop_front();
    return message;
  }

  void forget()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.clear();
  }

  const ros::Subscriber& subscriber() const { return subscriber_; }

private:
  std::mutex mutex_;
  std::deque<Ptr> messages_;
  ros::Subscriber subscriber_;  // last: gone before what its callback uses
};

/// Whether nothing comes any more but what is on its way, which takes long on a busy machine.
template <class Message>
bool fallsSilent(Probe<Message>& probe)
{
  for (int tries = 0; tries < 10; ++tries)
  {
    probe.forget();
    ros::WallDuration(0.5).sleep();
    if (probe.takeIfThere() == nullptr) return true;
  }
  return false;
}

/// To be called before anything makes a nodelet subscribe to the topic: where one thread advertises while another
/// subscribes, roscpp may connect the two twice, and every message arrives twice.
template <class Message>
ros::Publisher advertise(const std::string& topic)
{
  return ros::NodeHandle().advertise<Message>(topic, 100);
}

inline void waitForSubscriber(const ros::Publisher& publisher)
{
  EXPECT_TRUE(eventually([&] { return publisher.getNumSubscribers() > 0; })) << publisher.getTopic();
  EXPECT_EQ(publisher.getNumSubscribers(), 1U) << publisher.getTopic();
}

/// The latest /diagnostics of a nodelet by key, its message under "message", its level under "level".
class DiagnosticsProbe
{
public:
  explicit DiagnosticsProbe(std::string nodelet) : nodelet_(std::move(nodelet)), probe_("/diagnostics") {}

  /// The first report in which `key` is `value`; empty, with a failed test, when there is none.
  std::map<std::string, std::string> waitFor(const std::string& key, const std::string& value)
  {
    std::map<std::string, std::string> report;
    const bool found = eventually(
        [&]
        {
          while (const auto message = probe_.takeIfThere())
            if (read(*message, report) && report[key] == value) return true;
          return false;
        });
    EXPECT_TRUE(found) << nodelet_ << ": '" << key << "' is '" << report[key] << "', expected '" << value << "'";
    return found ? report : std::map<std::string, std::string>();
  }

private:
  bool read(const diagnostic_msgs::DiagnosticArray& message, std::map<std::string, std::string>& report) const
  {
    for (const auto& status : message.status)
    {
      if (("/" + status.name).find(nodelet_ + ": ") == std::string::npos) continue;
      report = {{"message", status.message}, {"level", std::to_string(status.level)}};
      for (const auto& item : status.values) report[item.key] = item.value;
      return true;
    }
    return false;
  }

  std::string nodelet_;
  Probe<diagnostic_msgs::DiagnosticArray> probe_;
};

/// What this process and others log.
class LogProbe
{
public:
  LogProbe() : probe_("/rosout")
  {
    EXPECT_TRUE(eventually([this] { return probe_.subscriber().getNumPublishers() > 0; }));
  }

  /// The first message from now on that contains `part`, of the node if one is given; "", with a failed test, when
  /// there is none.
  std::string waitFor(const std::string& part, const std::string& node = "")
  {
    std::string text;
    const bool found = eventually(
        [&]
        {
          while (const auto message = probe_.takeIfThere())
            if (message->header.stamp >= since_ && (text = message->msg).find(part) != std::string::npos &&
                (node.empty() || message->name == node))
              return true;
          return false;
        });
    EXPECT_TRUE(found) << "no log message with '" << part << "', the last one was '" << text << "'";
    return found ? text : "";
  }

private:
  const ros::Time since_ = ros::Time::now();  // /rosout of roscpp 1.14 is latched
  Probe<rosgraph_msgs::Log> probe_;
};

/// Nodelets in the test's own process, where sanitizers see them, in a manager with threads of its own.
class Graph : public testing::Test
{
protected:
  /// A name no other nodelet of this process has had, so that no parameter is left from another test.
  static std::string newName()
  {
    static std::atomic<int> count{0};
    return "/nodelet_" + std::to_string(++count);
  }

  bool tryLoad(const std::string& name, const std::string& type, const nodelet::M_string& remappings = {})
  {
    return loader_.load(name, "lidar_panoptic_clustering/" + type, remappings, {});
  }

  /// Loads a nodelet under a new name, and returns that.
  std::string load(const std::string& type)
  {
    const std::string name = newName();
    EXPECT_TRUE(tryLoad(name, type)) << type;
    return name;
  }

  nodelet::Loader loader_{false};
};

/// To be called by main: a node with the tests' callbacks in two threads, in the repository's root as gtests are.
inline int runGraphTests(int argc, char** argv, const std::string& node_name)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, node_name);
  std::filesystem::current_path(ros::package::getPath("lidar_panoptic_clustering"));
  ros::NodeHandle keeps_the_node_up;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
}  // namespace lidar_panoptic_clustering
