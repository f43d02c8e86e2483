#pragma once

#include "lidar_panoptic_clustering/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

namespace lidar_panoptic_clustering
{
inline std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// A sequence of scans of rectangles, 10 a second.
class TrackerScene : public testing::Test
{
protected:
  void begin(const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity())
  {
    pose_ = pose;
    builder_.begin(pose);
  }

  /// The points of a rectangle's sides, 5 cm apart, in the fixed frame [m].
  void add(std::uint32_t instance, const std::string& name, double x, double y, double length, double width,
           double yaw = 0.0)
  {
    for (double along = -0.5; along <= 0.5; along += 0.05 / length)
      for (double side : {-0.5, 0.5}) addPoint(instance, name, x, y, along * length, side * width, yaw);
    for (double along = -0.5; along <= 0.5; along += 0.05 / width)
      for (double side : {-0.5, 0.5}) addPoint(instance, name, x, y, side * length, along * width, yaw);
  }
  void car(std::uint32_t instance, double x, double y, double yaw = 0.0) { add(instance, "car", x, y, 4.5, 1.8, yaw); }
  void person(std::uint32_t instance, double x, double y) { add(instance, "person", x, y, 0.5, 0.5); }

  /// Follows what was added; the objects by the instance's number.
  std::map<std::uint32_t, TrackedObject> track(double time_s)
  {
    const Observations& observations = builder_.finish();
    const auto& objects = tracker_.update(std::llround(1e6 * time_s), observations);
    std::map<std::uint32_t, TrackedObject> by_instance;
    for (std::size_t i = 0; i < objects.size(); ++i) by_instance[observations.list[i].instance] = objects[i];
    EXPECT_EQ(by_instance.size(), objects.size());
    return by_instance;
  }

  Tracker tracker_{kitti()};

private:
  void addPoint(std::uint32_t instance, const std::string& name, double x, double y, double along, double across,
                double yaw)
  {
    const Eigen::Vector3d fixed(x + std::cos(yaw) * along - std::sin(yaw) * across,
                                y + std::sin(yaw) * along + std::cos(yaw) * across, 0.5);
    const Eigen::Vector3f p = (pose_.inverse() * fixed).cast<float>();
    builder_.add(instance, kitti()->findByName(name), p.x(), p.y(), p.z());
  }

  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  ObservationBuilder builder_{kitti()};
};
}  // namespace lidar_panoptic_clustering
