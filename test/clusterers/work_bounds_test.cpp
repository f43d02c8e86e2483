// What the algorithms look at stays linear in the points, however a scan is built.
#include "worst_scans.h"

#include "lidar_panoptic_clustering/clusterers/birds_eye_clusterer.h"
#include "lidar_panoptic_clustering/clusterers/depth_clusterer.h"
#include "lidar_panoptic_clustering/clusterers/scan_line_run_clusterer.h"

#include <gtest/gtest.h>

#include <iomanip>
#include <iostream>

namespace lidar_panoptic_clustering
{
namespace
{
std::size_t lookedAt(const DepthClusterer& clusterer)
{
  return clusterer.pairsLookedAt();
}
std::size_t lookedAt(const ScanLineRunClusterer& clusterer)
{
  return clusterer.pairsLookedAt();
}
std::size_t lookedAt(const BirdsEyeClusterer& clusterer)
{
  return clusterer.pointsLookedAt();
}

/// Comparisons a point of a build with so many rows.
template <class ClustererType>
double workOf(const WorstScan& worst, std::uint32_t rows, std::uint32_t columns, const std::string& policy)
{
  SelectionConfig config;
  config.class_policy = policy;
  ThingScan scan;
  selectThings(worst.build(rows, columns), *kittiTable(), config, scan);
  EXPECT_GT(scan.size(), rows * columns / 2) << worst.name;
  ClustererType clusterer;
  std::vector<std::uint32_t> component;
  clusterer.cluster(scan, component);
  return static_cast<double>(lookedAt(clusterer)) / static_cast<double>(scan.size());
}

/// No build takes more than `most` comparisons a point, and twice the points not many more a point.
template <class ClustererType>
void expectBounded(double most)
{
  for (const WorstScan& worst : worstScans())
    for (const std::string policy : {"class", "any"})
    {
      const double few = workOf<ClustererType>(worst, 16, 1024, policy);
      const double wide = workOf<ClustererType>(worst, 16, 2048, policy);
      const double high = workOf<ClustererType>(worst, 32, 2048, policy);
      std::cout << std::fixed << std::setprecision(1) << std::setw(28) << worst.name << ' ' << policy << ": " << few
                << ", " << wide << ", " << high << " a point\n";
      EXPECT_LE(high, most) << worst.name << ", " << policy;
      EXPECT_LE(high, 1.5 * wide + 2.0) << worst.name << ", " << policy;
    }
}

TEST(WorkBounds, depthComparesAPointWithTwoOthers)
{
  expectBounded<DepthClusterer>(2.1);
}

TEST(WorkBounds, scanLineRunComparesAPointWithTwoWindows)
{
  const ScanLineRunConfig config;
  // a block of eight more at either end of a window, and as many again while it looks at runs
  expectBounded<ScanLineRunClusterer>(config.max_line_gap * (2.0 * config.max_window_px + 16.0 + 8.0));
}

TEST(WorkBounds, ofPointsKnownToBeOneObjectOneIsEnough)
{
  // with every point of the window it is five times as many
  for (const WorstScan& worst : worstScans())
  {
    if (worst.name != "runs_of_one") continue;
    EXPECT_LE(workOf<ScanLineRunClusterer>(worst, 32, 2048, "class"), 60.0);
  }
}

TEST(WorkBounds, birdsEyeLooksAtAPointAFewTimesForEachCellAround)
{
  expectBounded<BirdsEyeClusterer>(24.0 * 6.0);
}

TEST(WorkBounds, wallsAtTheLinkDistanceCostTheSameAPointHoweverDense)
{
  // the n^1.5 of halving boxes would show as twice the work a point
  for (const WorstScan& worst : worstScans())
  {
    if (worst.name.find("two_walls") == std::string::npos) continue;
    const double thin = workOf<BirdsEyeClusterer>(worst, 8, 1024, "class");
    const double dense = workOf<BirdsEyeClusterer>(worst, 32, 1024, "class");
    EXPECT_LE(dense, 1.3 * thin + 2.0) << worst.name;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
