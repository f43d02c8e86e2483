#pragma once

#include "graph_fixture.h"
#include "scan_fixture.h"

#include <pcl_ros/point_cloud.h>
#include <tf2_msgs/TFMessage.h>

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;

constexpr std::uint32_t kScanPoints = 24;

/// Writes `bytes` bytes of `values`, all where 0.
template <class T>
void writeFile(const fs::path& path, const std::vector<T>& values, std::size_t bytes = 0)
{
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(bytes > 0 ? bytes : values.size() * sizeof(T)));
}

inline void writeText(const fs::path& path, const std::string& text)
{
  std::ofstream(path) << text;
}

/// Three rings of eight points at 10 m and a little more in each scan.
inline std::vector<float> scanPoints(int scan)
{
  std::vector<float> values;
  for (int ring = 0; ring < 3; ++ring)
    for (int i = 0; i < 8; ++i)
    {
      const float azimuth = 0.4F + 0.7853982F * static_cast<float>(i);
      const float range = 10.0F + static_cast<float>(scan);
      for (const float value : {range * std::cos(azimuth), range * std::sin(azimuth), static_cast<float>(-ring), 0.25F})
        values.push_back(value);
    }
  return values;
}

/// The first ring's points are cars of instance 5, moving ones, the others road.
inline std::vector<std::uint32_t> scanLabels(std::uint32_t car_label = 5U << 16U | kMovingCar)
{
  std::vector<std::uint32_t> labels(kScanPoints, kRoad);
  std::fill(labels.begin(), labels.begin() + 8, car_label);
  return labels;
}

/// A data set of three scans in a temporary folder, and a player of it.
class Player : public Graph
{
protected:
  Player() : root_(fs::temp_directory_path() / ("lidar_panoptic_player_" + std::to_string(getpid())))
  {
    fs::remove_all(root_);
    for (int scan = 0; scan < 3; ++scan)
    {
      writeFile(file("velodyne", scan, ".bin"), scanPoints(scan));
      writeFile(file("labels", scan, ".label"), scanLabels());
      writeFile(file("predictions", scan, ".label"), scanLabels(kPerson));
    }
    // the camera looks along the lidar's x, and drives 2 m a scan along its own z
    writeText(sequence() / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
    writeText(sequence() / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 4\n");
    writeText(sequence() / "times.txt", "0.0\n0.25\n0.5\n");
    ros::param::set(name_ + "/dataset", root_.string());
    ros::param::set(name_ + "/sequence", 7);  // as roslaunch makes of "07"
    ros::param::set(name_ + "/rows", 4);
    ros::param::set(name_ + "/columns", 32);
    ros::param::set(name_ + "/rate_hz", 50.0);
    ros::param::set(name_ + "/loop", false);
  }
  ~Player() override
  {
    loader_.clear();
    fs::remove_all(root_);
  }

  fs::path sequence() const { return root_ / "sequences" / "07"; }
  fs::path file(const std::string& folder, int scan, const std::string& ending) const
  {
    return sequence() / folder / ("00000" + std::to_string(scan) + ending);
  }
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

  const fs::path root_;
  const std::string name_ = newName();
};

using PointSet = std::multiset<std::tuple<float, float, float, std::uint32_t>>;

template <class Cloud>
PointSet returnsIn(const Cloud& cloud)
{
  PointSet set;
  for (const auto& p : cloud.points)
    if (!std::isnan(p.x)) set.emplace(p.x, p.y, p.z, p.label);
  return set;
}

inline PointSet expectedReturns(int scan, std::uint32_t car_label)
{
  const auto values = scanPoints(scan);
  PointSet set;
  for (std::size_t i = 0; i < kScanPoints; ++i)
    set.emplace(values[4 * i], values[4 * i + 1], values[4 * i + 2], i < 8 ? car_label : kRoad);
  return set;
}
}  // namespace lidar_panoptic_clustering
