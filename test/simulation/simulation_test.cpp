#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/simulation/labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace lidar_panoptic_clustering
{
using namespace simulation;

namespace
{
std::string messageOf(const std::function<void()>& call)
{
  try
  {
    call();
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "nothing was thrown";
}

bool sameBits(const PanopticCloud& a, const PanopticCloud& b)
{
  bool same = a.width == b.width && a.height == b.height && a.size() == b.size();
  for (std::size_t i = 0; same && i < a.size(); ++i)
  {
    const PanopticPoint &p = a.points[i], &q = b.points[i];
    same = std::memcmp(p.data, q.data, sizeof p.data) == 0 && p.intensity == q.intensity && p.label == q.label &&
           p.instance == q.instance && p.rgb == q.rgb;
  }
  return same;
}

PanopticCloud scanOf(LidarSimulator& simulator, std::uint64_t frame)
{
  PanopticCloud cloud;
  simulator.scan(frame, cloud);
  return cloud;
}

}  // namespace

TEST(LidarSimulator, SameFrameSameBits)
{
  LidarSimulator forward, anywhere;
  const PanopticCloud zero = scanOf(forward, 0), seven = scanOf(forward, 7), far = scanOf(forward, 123456);
  EXPECT_TRUE(sameBits(scanOf(anywhere, 123456), far));
  EXPECT_TRUE(sameBits(scanOf(anywhere, 7), seven));
  EXPECT_TRUE(sameBits(scanOf(anywhere, 0), zero));
  EXPECT_FALSE(sameBits(zero, seven));

  SimulatorConfig config;
  config.seed = 2;
  LidarSimulator other(SensorModel::load("hdl64e"), config);
  EXPECT_FALSE(sameBits(scanOf(other, 0), zero));
}

TEST(LidarSimulator, ScanIsOrganisedAndWithinTheModelsLimits)
{
  const SensorModel model = SensorModel::load("hdl64e");
  LidarSimulator simulator;
  for (const std::uint64_t frame : {0, 50, 1000})
  {
    const PanopticCloud cloud = scanOf(simulator, frame);
    ASSERT_EQ(cloud.height, 64U);
    ASSERT_EQ(cloud.width, 2048U);
    ASSERT_EQ(cloud.size(), 64U * 2048U);
    EXPECT_FALSE(cloud.is_dense);
    std::size_t returns = 0, things = 0;
    for (std::uint32_t row = 0; row < cloud.height; ++row)
      for (std::uint32_t column = 0; column < cloud.width; ++column)
      {
        const PanopticPoint& point = cloud.at(column, row);
        if (!std::isfinite(point.x)) continue;
        ++returns;
        things += point.instance > 0 ? 1 : 0;
        const float horizontal = std::hypot(point.x, point.y), range = std::hypot(horizontal, point.z);
        ASSERT_GE(range, model.min_range_m - 1e-4F);
        ASSERT_LE(range, model.max_range_m + 1e-4F);
        ASSERT_NEAR(std::atan2(point.z, horizontal), model.elevations_rad[row], 1e-5F);
        ASSERT_NEAR(std::remainder(std::atan2(point.y, point.x) - model.azimuth(column), 2.0 * M_PI), 0.0, 1e-5);
        ASSERT_GE(point.z, -model.mount_height_m - 0.1F);
        ASSERT_GE(point.intensity, 0.0F);
        ASSERT_LE(point.intensity, 1.0F);
      }
    EXPECT_GT(returns, cloud.size() * 6 / 10) << "frame " << frame;
    EXPECT_GT(things, returns * 3 / 100) << "frame " << frame;
  }
}

TEST(LidarSimulator, LabelsAreExactAndComplete)
{
  const ClassTable table = ClassTable::load("semantic_kitti");
  LidarSimulator simulator;
  std::set<std::uint32_t> labels;
  for (std::uint64_t frame = 0; frame < 2400; frame += 120)
  {
    const PanopticCloud cloud = scanOf(simulator, frame);
    std::map<std::uint32_t, std::uint32_t> label_of;
    for (const PanopticPoint& point : cloud.points)
    {
      if (!std::isfinite(point.x)) continue;
      labels.insert(point.label);
      ASSERT_EQ(table[table.find(point.label)].isThing(), point.instance > 0) << "label " << point.label;
      ASSERT_LT(point.instance, 65536U);
      if (point.instance == 0) continue;
      ASSERT_EQ(label_of.emplace(point.instance, point.label).first->second, point.label);
    }
  }
  for (const std::uint32_t expected : {label::kCar,
                                       label::kMovingCar,
                                       label::kTruck,
                                       label::kMovingTruck,
                                       label::kBus,
                                       label::kMovingBus,
                                       label::kOtherVehicle,
                                       label::kBicycle,
                                       label::kMotorcycle,
                                       label::kPerson,
                                       label::kMovingPerson,
                                       label::kBicyclist,
                                       label::kMovingBicyclist,
                                       label::kMovingMotorcyclist,
                                       label::kRoad,
                                       label::kLaneMarking,
                                       label::kParking,
                                       label::kSidewalk,
                                       label::kOtherGround,
                                       label::kBuilding,
                                       label::kFence,
                                       label::kVegetation,
                                       label::kTrunk,
                                       label::kTerrain,
                                       label::kPole,
                                       label::kTrafficSign})
    EXPECT_EQ(labels.count(expected), 1U) << "label " << expected;
}

TEST(LidarSimulator, ParkedCarsKeepTheirInstanceAndPlace)
{
  LidarSimulator simulator;
  const auto centres = [&](std::uint64_t frame)
  {
    const Pose pose = simulator.pose(frame);
    std::map<std::uint32_t, Eigen::Vector3d> sums;
    for (const PanopticPoint& point : scanOf(simulator, frame).points)
    {
      if (!std::isfinite(point.x) || point.label != label::kCar || std::hypot(point.x, point.y) > 30.0F) continue;
      auto& sum = sums.emplace(point.instance, Eigen::Vector3d::Zero()).first->second;
      const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
      sum += Eigen::Vector3d(pose.x + c * point.x - s * point.y, pose.y + s * point.x + c * point.y, 1.0);
    }
    for (auto& [instance, sum] : sums) sum /= sum.z();
    return sums;
  };
  const auto before = centres(100), after = centres(105);  // 4 m further
  int seen_twice = 0;
  for (const auto& [instance, centre] : before)
    if (const auto it = after.find(instance); it != after.end())
    {
      ++seen_twice;
      EXPECT_LT((it->second - centre).norm(), 2.5) << "instance " << instance;
    }
  EXPECT_GT(seen_twice, 3);
}

TEST(LidarSimulator, NoTwoThingsShareAPlace)
{
  // a weak but simple sign: the mean places of two objects, whatever their size, keep apart
  for (const double time : {0.0, 40.0, 300.0})
  {
    Street street({3, 1.0, 1.0}, {3, 8.0, 1.0, 1.0});
    std::vector<Solid> solids;
    street.collect(time, 8.0 * time, 120.0, solids);
    std::map<std::uint32_t, std::pair<Eigen::Vector2d, int>> sums;
    std::map<std::uint32_t, std::uint32_t> label_of;
    for (const Solid& solid : solids)
    {
      if (solid.surface.instance == 0) continue;
      auto& [sum, count] =
          sums.emplace(solid.surface.instance, std::make_pair(Eigen::Vector2d::Zero(), 0)).first->second;
      sum += solid.center.head<2>(), ++count;
      EXPECT_EQ(label_of.emplace(solid.surface.instance, solid.surface.label).first->second, solid.surface.label);
    }
    EXPECT_GT(sums.size(), 150U);
    for (auto a = sums.begin(); a != sums.end(); ++a)
      for (auto b = std::next(a); b != sums.end(); ++b)
        EXPECT_GT((a->second.first / a->second.second - b->second.first / b->second.second).norm(), 0.3)
            << "labels " << label_of[a->first] << " and " << label_of[b->first] << " at " << time << " s";
  }
}

TEST(LidarSimulator, RefusesBadParameters)
{
  SimulatorConfig config;
  config.rate_hz = 0.0;
  EXPECT_NE(messageOf([&] { LidarSimulator(SensorModel::load("hdl64e"), config); }).find("rate_hz"), std::string::npos);
  config = {};
  config.traffic_density = 1.5;
  EXPECT_NE(messageOf([&] { LidarSimulator(SensorModel::load("hdl64e"), config); }).find("traffic_density"),
            std::string::npos);
  config = {};
  EXPECT_NE(messageOf([&] { applyParameters(config, {{"seed", -1}}); }).find("seed"), std::string::npos);

  SensorModel model = SensorModel::load("hdl64e");
  std::swap(model.elevations_rad[3], model.elevations_rad[4]);
  EXPECT_NE(messageOf([&] { LidarSimulator{model}; }).find("ring 4"), std::string::npos);
  model = SensorModel::load("hdl64e");
  model.columns = 0;
  EXPECT_NE(messageOf([&] { LidarSimulator{model}; }).find("columns"), std::string::npos);
  model = SensorModel::load("hdl64e");
  model.max_range_m = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(messageOf([&] { LidarSimulator{model}; }).find("max_range_m"), std::string::npos);
  model.elevations_rad.clear();
  EXPECT_NE(messageOf([&] { LidarSimulator{model}; }).find("elevations"), std::string::npos);

  LidarSimulator simulator;
  PanopticCloud cloud;
  const auto last = std::numeric_limits<std::uint64_t>::max();
  EXPECT_NE(messageOf([&] { simulator.scan(last, cloud); }).find("frame"), std::string::npos);
}

TEST(LidarSimulator, DropoutScaleAndNoiseScale)
{
  SimulatorConfig config;
  config.noise_scale = config.dropout_scale = 0.0;
  LidarSimulator clean(SensorModel::load("hdl64e"), config), usual;
  const PanopticCloud exact = scanOf(clean, 3), noisy = scanOf(usual, 3);
  double squares = 0.0;
  int both = 0, dropped = 0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const auto &p = exact.points[i], &q = noisy.points[i];
    if (!std::isfinite(p.x)) continue;
    dropped += std::isfinite(q.x) ? 0 : 1;
    if (!std::isfinite(q.x)) continue;
    EXPECT_EQ(p.label, q.label);
    const double error = q.getVector3fMap().norm() - p.getVector3fMap().norm();
    squares += error * error, ++both;
  }
  EXPECT_NEAR(std::sqrt(squares / both), SensorModel::load("hdl64e").range_noise_m, 0.001);
  EXPECT_GT(dropped, both / 100);
}
}  // namespace lidar_panoptic_clustering
