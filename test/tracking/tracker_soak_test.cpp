// A drive of a thousand seconds: neither tracks nor memory grow.
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
/// Of this process [bytes]; 0 where it cannot be told.
std::size_t residentBytes()
{
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // slow, and what was freed is kept for a while
#else
constexpr bool kSanitized = false;
#endif

TEST(TrackerSoak, TenThousandScansTakeNoMoreMemoryThanTwoThousand)
{
  constexpr std::uint64_t kScans = kSanitized ? 1000 : 10000, kWarm = kScans / 5;
  constexpr std::size_t kSlack = 4U << 20U;  // a vector that grows once more
  SensorModel model = SensorModel::load("vlp16");
  model.columns = 180;
  LidarSimulator simulator(model);
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  CloudTracker tracker(table);
  PanopticCloud scan, out;
  std::size_t most = 0, warm = 0;
  std::uint32_t newest = 0;
  for (std::uint64_t frame = 0; frame < kScans; ++frame)
  {
    simulator.scan(frame, scan);
    const simulation::Pose at = simulator.pose(frame);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(at.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(at.x, at.y, at.z);
    tracker.follow(scan, static_cast<std::int64_t>(100000 * frame), pose);
    tracker.paint(scan, out);
    for (const ListedTrack& listed : tracker.list(scan)) newest = std::max(newest, listed.object.track);
    most = std::max(most, tracker.liveTracks());
    if (frame == kWarm) warm = residentBytes();
  }
  EXPECT_GT(newest, kScans / 10) << "the drive passes many objects";
  EXPECT_LT(most, 500U);
  EXPECT_GT(warm, 0U);
  if (!kSanitized)
  {
    EXPECT_LT(residentBytes(), warm + kSlack);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
