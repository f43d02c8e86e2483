#pragma once

#include "graph_fixture.h"
#include "tiny_dataset.h"

#include <pcl_ros/point_cloud.h>
#include <tf2_msgs/TFMessage.h>

#include <memory>
#include <string>

namespace lidar_panoptic_clustering
{
/// A data set of three scans in a temporary folder, and a player of it.
class Player : public Graph, protected TinyDataset
{
protected:
  Player() : TinyDataset("player")
  {
    ros::param::set(name_ + "/dataset", root_.string());
    ros::param::set(name_ + "/sequence", 7);  // as roslaunch makes of "07"
    ros::param::set(name_ + "/rows", 4);
    ros::param::set(name_ + "/columns", 32);
    ros::param::set(name_ + "/rate_hz", 50.0);
    ros::param::set(name_ + "/loop", false);
  }
  ~Player() override { loader_.clear(); }

  bool start() { return tryLoad(name_, "SemanticKittiPlayerNodelet"); }

  /// Listens to ground truth and tf first: the player waits for a listener of its output.
  struct Listener
  {
    explicit Listener(const std::string& player) : ground_truth(player + "/ground_truth"), tf("/tf")
    {
      EXPECT_TRUE(eventually([this] { return ground_truth.subscriber().getNumPublishers() > 0; }));
      output = std::make_unique<Probe<LabelledCloud>>(player + "/output");
    }
    Probe<PanopticCloud> ground_truth;
    Probe<tf2_msgs::TFMessage> tf;
    std::unique_ptr<Probe<LabelledCloud>> output;
  };

  /// How many clouds come before the player logs `last_words`.
  std::size_t cloudsUntil(const std::string& last_words)
  {
    LogProbe log;
    EXPECT_TRUE(start());
    Probe<LabelledCloud> output(name_ + "/output");
    EXPECT_NE(log.waitFor(last_words), "");
    ros::WallDuration(0.2).sleep();
    std::size_t count = 0;
    while (output.takeIfThere()) ++count;
    return count;
  }

  void expectRefused(const std::string& reason)
  {
    LogProbe log;
    EXPECT_FALSE(start());
    const std::string message = log.waitFor("not loaded");
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  }

  const std::string name_ = newName();
};
}  // namespace lidar_panoptic_clustering
