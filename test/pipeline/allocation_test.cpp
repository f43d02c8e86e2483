// Once it has seen scans of the kind, the way of a scan allocates nothing, the output included where it comes from a
// pool.
#include "allocation_count.h"
#include "scan_fixture.h"
#include "unordered_clouds.h"

#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
std::vector<LabelledCloud> streetScans()
{
  LidarSimulator simulator;
  std::vector<LabelledCloud> scans;
  PanopticCloud scan;
  for (std::uint64_t frame = 0; frame < 3; ++frame)
  {
    simulator.scan(20 * frame, scan);
    scans.emplace_back(scan.width, scan.height);
    for (std::size_t k = 0; k < scan.points.size(); ++k)
    {
      scans.back().points[k].getVector4fMap() = scan.points[k].getVector4fMap();
      scans.back().points[k].label = scan.points[k].label;
    }
  }
  return scans;
}

class SteadyState : public testing::TestWithParam<std::string>
{
protected:
  void SetUp() override
  {
    if (LIDAR_PANOPTIC_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted in this build";
    const std::size_t before = allocations;
    const auto counted = std::make_unique<int>(1);
    ASSERT_EQ(allocations, before + 1) << "the counter does not count " << *counted;
  }
};

TEST_P(SteadyState, selectingAndClusteringAllocateNothing)
{
  const auto scans = streetScans();
  const Algorithm made = makeAlgorithm(GetParam());
  ThingScan things;
  std::vector<std::uint32_t> component;
  const auto work = [&]
  {
    for (const auto& scan : scans)
    {
      selectThings(scan, *kittiTable(), made.pipeline.selection, things);
      made.clusterer->cluster(things, component);
    }
  };
  work();
  const std::size_t before = allocations;
  work();
  EXPECT_EQ(allocations, before);
}

TEST_P(SteadyState, theWholeWayAllocatesOnlyTheOutput)
{
  const auto scans = streetScans();
  Algorithm made = makeAlgorithm(GetParam());
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  PanopticCloud recycled;
  const auto work = [&](bool fresh)
  {
    for (const auto& scan : scans)
    {
      pipeline.segment(scan);
      PanopticCloud out;
      pipeline.paint(scan, fresh ? out : recycled);
    }
  };
  work(false);
  work(false);  // colours look back one scan

  std::size_t before = allocations;
  work(false);
  EXPECT_EQ(allocations, before) << "with an output that is used again";
  before = allocations;
  work(true);
  EXPECT_LE(allocations, before + scans.size()) << "with fresh outputs";
}

/// The street stands still here, and is left and come back to: tracks are born, hidden and lost all the time.
TEST(TrackingSteadyState, AllocatesOnlyTheOutput)
{
  if (LIDAR_PANOPTIC_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted in this build";
  LidarSimulator simulator;
  std::vector<PanopticCloud> scans(4);
  for (std::size_t k = 0; k < scans.size(); ++k) simulator.scan(20 * k, scans[k]);
  CloudTracker tracker(kittiTable());
  PanopticCloud recycled;
  std::int64_t stamp_us = 0;
  const auto work = [&](bool fresh)
  {
    for (int round = 0; round < 10; ++round)
      for (const PanopticCloud& scan : scans)
      {
        tracker.follow(scan, stamp_us += 100000, Eigen::Isometry3d::Identity());
        PanopticCloud out;
        tracker.paint(scan, fresh ? out : recycled);
        tracker.list(scan);
      }
  };
  work(false);
  work(false);
  std::size_t before = allocations;
  work(false);
  EXPECT_EQ(allocations, before) << "with an output that is used again";
  before = allocations;
  work(true);
  EXPECT_LE(allocations, before + 10 * scans.size()) << "with fresh outputs";
}

TEST(LabellingSteadyState, rowsAllocateNothing)
{
  if (LIDAR_PANOPTIC_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted in this build";
  auto scans = streetScans();
  GroundLabeler labeler{GroundLabelerConfig{}};
  for (auto& scan : scans) labeler.label(scan);
  const std::size_t before = allocations;
  for (auto& scan : scans) labeler.label(scan);
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(labeler.foundGround());
}

TEST(LabellingSteadyState, pointsInNoOrderAllocateNothing)
{
  if (LIDAR_PANOPTIC_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted in this build";
  std::vector<std::vector<ScanPoint>> clouds;
  for (const auto& scan : streetScans())
  {
    clouds.emplace_back();
    for (const auto& p : scan.points) clouds.back().push_back({p.x, p.y, p.z, 0.0F});
  }
  GroundLabeler labeler{GroundLabelerConfig{}};
  std::vector<std::uint32_t> labels;
  for (const auto& cloud : clouds) labeler.labelUnordered(cloud, labels);
  const std::size_t before = allocations;
  for (const auto& cloud : clouds) labeler.labelUnordered(cloud, labels);
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(labeler.foundGround());
}

/// From the driver's cloud to objects, boxes and the way back to its points, without a network.
class ChainSteadyState : public testing::TestWithParam<const char*>
{
};

TEST_P(ChainSteadyState, theWayWithoutANetworkAllocatesNothing)
{
  if (LIDAR_PANOPTIC_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted in this build";
  std::vector<RawMessage> messages;
  for (const auto& scan : streetScans())
  {
    std::vector<std::uint32_t> all(scan.size());
    std::iota(all.begin(), all.end(), 0U);
    messages.push_back(oneRow(scan, all, Rings::kFromTheTop));
    if (GetParam() == std::string("ring")) continue;
    auto& header = messages.back().header;
    header.height = scan.height, header.width = scan.width, header.row_step = scan.width * header.point_step;
    if (GetParam() == std::string("firings")) messages.back() = transposed(messages.back());
  }
  std::vector<RawCloud> clouds;
  for (const auto& message : messages) clouds.push_back(message.view());
  ScanToObjectsConfig config;
  config.labeller.labels = "none";
  ScanToObjects chain(config);
  const auto work = [&]
  {
    for (const auto& cloud : clouds) chain.process(cloud);
  };
  work();
  work();  // colours look back one scan
  const std::size_t before = allocations;
  work();
  EXPECT_EQ(allocations, before);
  EXPECT_GT(chain.instances().count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Layouts, ChainSteadyState, testing::Values("rings", "firings", "ring"),
                         [](const auto& test) { return test.param; });

TEST_P(SteadyState, withAPoolOfOutputsNothingIsAllocated)
{
  const auto scans = streetScans();
  Algorithm made = makeAlgorithm(GetParam());
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  CloudPool<PanopticCloud> pool;
  PanopticCloud::Ptr reader;  // holds each frame until the next one has come, as a subscriber does
  const auto work = [&]
  {
    for (const auto& scan : scans)
    {
      const PanopticCloud::Ptr out = pool.take();
      pipeline.process(scan, *out);
      reader = out;
    }
  };
  work();
  work();
  const std::size_t before = allocations;
  work();
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(pool.made(), 2U);
}

TEST_P(SteadyState, oneOrTwoPassesGiveTheSame)
{
  const auto scans = streetScans();
  Algorithm made = makeAlgorithm(GetParam()), again = makeAlgorithm(GetParam());
  FramePipeline two(kittiTable(), made.pipeline, std::move(made.clusterer));
  FramePipeline one(kittiTable(), again.pipeline, std::move(again.clusterer));
  for (const auto& scan : scans)
  {
    PanopticCloud expected, found;
    two.segment(scan);
    two.paint(scan, expected);
    one.process(scan, found);
    ASSERT_EQ(found.points.size(), expected.points.size());
    EXPECT_EQ(found.width, expected.width);
    EXPECT_EQ(found.header.stamp, expected.header.stamp);
    std::size_t different = 0;
    for (std::size_t k = 0; k < found.points.size(); ++k)
      different += std::memcmp(&found.points[k], &expected.points[k], sizeof(PanopticPoint)) != 0 ? 1U : 0U;
    EXPECT_EQ(different, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, SteadyState, testing::Values("depth", "scan_line_run", "birds_eye"),
                         [](const auto& test) { return test.param; });
}  // namespace
}  // namespace lidar_panoptic_clustering
