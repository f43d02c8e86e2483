// Every algorithm on every sensor that ships with the package, in the simulated street with true classes.
#include "scan_fixture.h"

#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNear = 30.0F;          // [m]
constexpr std::size_t kFewPoints = 10;  // a true object of fewer is not counted: there is little to see

/// Scans of three streets, three moments each.
std::vector<PanopticCloud> scansOf(const SensorModel& sensor)
{
  std::vector<PanopticCloud> scans;
  for (int seed = 1; seed <= 3; ++seed)
  {
    SimulatorConfig config;
    config.seed = seed;
    LidarSimulator simulator(sensor, config);
    for (const std::uint64_t frame : {0, 100, 200}) simulator.scan(frame, scans.emplace_back());
  }
  return scans;
}

LabelledCloud withoutInstances(const PanopticCloud& truth)
{
  LabelledCloud cloud(truth.width, truth.height);
  cloud.is_dense = false;
  for (std::size_t i = 0; i < truth.size(); ++i)
  {
    const PanopticPoint& p = truth.points[i];
    cloud.points[i] = labelled(p.x, p.y, p.z, p.label);
  }
  return cloud;
}

/// Raw classes and instances of the returns.
struct Labels
{
  explicit Labels(const PanopticCloud& cloud)
  {
    for (const PanopticPoint& p : cloud.points)
      if (std::isfinite(p.x)) classes.push_back(p.label), instances.push_back(p.instance);
  }
  ScanLabels view() const { return ScanLabels::separate(classes.data(), instances.data()); }

  std::vector<std::uint32_t> classes, instances;
};

struct Found
{
  int found = 0, all = 0;
  double share() const { return static_cast<double>(found) / all; }
};

/// A true object counts as found where an instance of its class covers more than half of their union.
void countFound(const PanopticCloud& truth, const PanopticCloud& out, std::map<std::string, Found>& counts)
{
  struct Object
  {
    std::size_t points = 0;
    float nearest = std::numeric_limits<float>::max();
    ClassIndex type = kUnknownClass;
    std::map<std::pair<std::uint32_t, ClassIndex>, std::size_t> covered_by;
  };
  std::map<std::uint32_t, Object> objects;
  std::map<std::pair<std::uint32_t, ClassIndex>, std::size_t> sizes;
  for (std::size_t i = 0; i < truth.size(); ++i)
  {
    const PanopticPoint &t = truth.points[i], &o = out.points[i];
    const auto segment = std::make_pair(o.instance, kittiTable()->find(o.label));
    if (o.instance > 0) ++sizes[segment];
    if (t.instance == 0) continue;
    Object& object = objects[t.instance];
    ++object.points;
    object.nearest = std::min(object.nearest, std::hypot(t.x, t.y));
    object.type = kittiTable()->find(t.label);
    ++object.covered_by[segment];
  }
  for (const auto& [id, object] : objects)
  {
    if (object.points < kFewPoints || object.nearest > kNear) continue;
    Found& count = counts[(*kittiTable())[object.type].name];
    ++count.all;
    for (const auto& [segment, both] : object.covered_by)
      if (segment.second == object.type && 2 * both > object.points + sizes[segment] - both) ++count.found;
  }
}

class SimulatedSensors : public testing::TestWithParam<std::tuple<std::string, std::string>>
{
};

// Measured on these scans: cars 99 to 100 %, people 89 to 97 % (supervoxel at the lower end, the others from 93 % on),
// PQ of things 96.0 to 98.6.
TEST_P(SimulatedSensors, NearCarsAndPeopleAreFound)
{
  const auto& [sensor, algorithm] = GetParam();
  Algorithm made = makeAlgorithm(algorithm);
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  PanopticQuality quality(kittiTable(), kFewPoints);
  std::map<std::string, Found> counts;
  PanopticCloud out;
  for (const PanopticCloud& truth : scansOf(SensorModel::load(sensor)))
  {
    const LabelledCloud cloud = withoutInstances(truth);
    pipeline.segment(cloud);
    pipeline.paint(cloud, out);
    countFound(truth, out, counts);
    const Labels found(out), expected(truth);
    quality.addScan(found.view(), expected.view(), found.classes.size());
  }
  const double pq = quality.figures().pq_th_present;
  std::printf("%s, %s: PQ of things %.1f", sensor.c_str(), algorithm.c_str(), 100.0 * pq);
  for (const auto& [name, count] : counts) std::printf(", %s %d of %d", name.c_str(), count.found, count.all);
  std::printf("\n");

  EXPECT_GE(counts["car"].all, 100);
  EXPECT_GE(counts["person"].all, 70);
  EXPECT_GE(counts["car"].share(), 0.97);
  EXPECT_GE(counts["person"].share(), algorithm == "supervoxel" ? 0.86 : 0.90);
  EXPECT_GE(pq, 0.94);
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedSensors,
                         testing::Combine(testing::ValuesIn(SensorModel::shippedNames()),
                                          testing::ValuesIn(algorithmNames())),
                         [](const auto& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });
}  // namespace
}  // namespace lidar_panoptic_clustering
