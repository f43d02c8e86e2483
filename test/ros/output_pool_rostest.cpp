// What a nodelet allocates for a scan in a living graph, once it has seen scans of the kind.
#include "allocation_count.h"
#include "graph_fixture.h"
#include "labelled_scene.h"

#include <pcl_ros/point_cloud.h>

#include <cstddef>
#include <deque>
#include <iostream>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kRows = 64, kColumns = 2048;

boost::shared_ptr<const LabelledCloud> fullScan()
{
  LabelledCloud cloud = randomScan(3, kRows, kColumns);
  cloud.header.frame_id = "lidar";
  cloud.header.stamp = 1700000000123456;
  return share(cloud);
}

class OutputPool : public Graph, public testing::WithParamInterface<std::string>
{
protected:
  /// Sends a scan `count` times, each when the one before has come out; the last `held` outputs are kept. Returns
  /// whether all came out.
  bool send(int count, std::size_t held)
  {
    for (int k = 0; k < count; ++k)
    {
      input_.publish(scan_);
      kept_.push_back(output_->next());
      if (!kept_.back()) return false;
      while (kept_.size() > held) kept_.pop_front();
    }
    return true;
  }

  /// Prints what a scan takes.
  void expectNoLargeBlock(std::size_t held)
  {
    ASSERT_TRUE(send(8, held));
    constexpr int kScans = 20;
    const std::size_t all_before = allocations, large_before = large_allocations;
    ASSERT_TRUE(send(kScans, held));
    const std::size_t all = allocations - all_before, large = large_allocations - large_before;
    EXPECT_EQ(large, 0U) << "with " << held << " outputs held by a reader";
    std::cout << GetParam() << ", " << held << " outputs held: " << large << " blocks of 64 KB and more for " << kScans
              << " scans, " << all / kScans << " of any size a scan\n";
  }

  void SetUp() override
  {
    if (LIDAR_PANOPTIC_COUNTS_ALLOCATIONS == 0) GTEST_SKIP() << "allocations cannot be counted in this build";
    const std::size_t before = large_allocations;
    const std::vector<char> counted(kLargeBlock);
    ASSERT_EQ(large_allocations, before + 1) << "the counter does not count " << counted.size();
    const std::string name = load(clusterNodelet(GetParam()));
    input_ = advertise<LabelledCloud>(name + "/input");
    output_ = std::make_unique<Probe<PanopticCloud>>(name + "/output");
    waitForSubscriber(input_);
  }

  boost::shared_ptr<const LabelledCloud> scan_ = fullScan();
  ros::Publisher input_;
  std::unique_ptr<Probe<PanopticCloud>> output_;
  std::deque<Probe<PanopticCloud>::Ptr> kept_;
};
INSTANTIATE_TEST_SUITE_P(Algorithms, OutputPool, testing::Values("depth", "scan_line_run", "birds_eye"),
                         [](const auto& instance) { return instance.param; });

/// Each output lies in a cloud that came back: 4 MB a scan otherwise.
TEST_P(OutputPool, AllocatesNoCloudInSteadyState)
{
  expectNoLargeBlock(0);
}

TEST_P(OutputPool, AllocatesNoCloudWhileAReaderHoldsThree)
{
  expectNoLargeBlock(3);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "output_pool_test");
}
