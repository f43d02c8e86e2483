#include "lidar_panoptic_clustering/evaluation/object_errors.h"

#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// `points` points of one true and one predicted label each.
struct Run
{
  std::uint32_t points, true_class, true_instance, found_class, found_instance;
};

/// Outcomes by true instance.
std::map<std::uint32_t, ObjectOutcome> outcomes(const std::vector<Run>& runs, int min_points = 1)
{
  std::vector<std::uint32_t> truth, found;
  for (const Run& run : runs)
  {
    truth.insert(truth.end(), run.points, run.true_instance << 16U | run.true_class);
    found.insert(found.end(), run.points, run.found_instance << 16U | run.found_class);
  }
  SegmentOverlaps overlaps(kitti());
  overlaps.count(ScanLabels::packed(found.data()), ScanLabels::packed(truth.data()), truth.size());
  ObjectErrors errors(min_points);
  std::map<std::uint32_t, ObjectOutcome> result;
  for (const TrueObject& object : errors.judge(overlaps)) result[object.segment.instance] = object.outcome;
  return result;
}

using Outcomes = std::map<std::uint32_t, ObjectOutcome>;
constexpr auto kMatched = ObjectOutcome::kMatched;
constexpr auto kSplit = ObjectOutcome::kSplit;
constexpr auto kMerged = ObjectOutcome::kMerged;
constexpr auto kMissed = ObjectOutcome::kMissed;
constexpr std::uint32_t kCar = 10, kTruck = 18, kRoad = 40;
}  // namespace

TEST(ObjectErrors, NothingInNothingOut)
{
  EXPECT_TRUE(outcomes({}).empty());
}

TEST(ObjectErrors, Matched)
{
  EXPECT_EQ(outcomes({{6, kCar, 1, kCar, 9}, {4, kCar, 1, kCar, 8}}), (Outcomes{{1, kMatched}}));
}

TEST(ObjectErrors, SplitInTwoHalves)
{
  EXPECT_EQ(outcomes({{5, kCar, 1, kCar, 8}, {5, kCar, 1, kCar, 9}}), (Outcomes{{1, kSplit}}));
}

TEST(ObjectErrors, TwoOfOneSizeMerged)
{
  EXPECT_EQ(outcomes({{5, kCar, 1, kCar, 8}, {5, kCar, 2, kCar, 8}}), (Outcomes{{1, kMerged}, {2, kMerged}}));
}

TEST(ObjectErrors, SmallSwallowedByLarge)
{
  EXPECT_EQ(outcomes({{9, kCar, 1, kCar, 8}, {4, kCar, 2, kCar, 8}}), (Outcomes{{1, kMatched}, {2, kMerged}}));
}

TEST(ObjectErrors, SmallSwallowedByAPieceOfLarge)
{
  EXPECT_EQ(outcomes({{6, kCar, 1, kCar, 8}, {3, kCar, 2, kCar, 8}, {6, kCar, 1, kCar, 9}}),
            (Outcomes{{1, kSplit}, {2, kMerged}}));
}

TEST(ObjectErrors, MissedWhereMostOfItHasNoInstance)
{
  EXPECT_EQ(outcomes({{2, kCar, 1, kCar, 8}, {2, kCar, 1, kCar, 9}, {4, kCar, 1, kCar, 0}, {9, kCar, 2, kCar, 0}}),
            (Outcomes{{1, kMissed}, {2, kMatched}}));
  EXPECT_EQ(outcomes({{5, kCar, 1, kRoad, 0}}), (Outcomes{{1, kMissed}}));
}

TEST(ObjectErrors, WrongClassIsMissedAndNotSplit)
{
  EXPECT_EQ(outcomes({{9, kCar, 1, kTruck, 8}, {1, kCar, 1, kCar, 9}}), (Outcomes{{1, kMissed}}));
}

TEST(ObjectErrors, DrownedInItsSurroundingsIsMissed)
{
  EXPECT_EQ(outcomes({{5, kCar, 1, kCar, 8}, {9, kRoad, 0, kCar, 8}}), (Outcomes{{1, kMissed}}));
}

TEST(ObjectErrors, SmallObjectsAndIgnoredPointsDoNotCount)
{
  EXPECT_EQ(outcomes({{4, kCar, 1, kCar, 8}, {5, kCar, 2, kCar, 9}, {9, 0, 3, kCar, 9}}, 5), (Outcomes{{2, kMatched}}));
}

TEST(ObjectErrors, ErrorsAreTheFalseNegativesOfThings)
{
  std::mt19937 random(5);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  const std::vector<std::uint32_t> ids{0, kCar, 252, kTruck, kRoad};
  PanopticQuality quality(kitti(), 6);
  ObjectErrors errors(6);
  ObjectErrorCounts counts;
  for (int scan = 0; scan < 500; ++scan)
  {
    std::vector<std::uint32_t> truth, found;
    for (int run = 0; run < 25; ++run)
    {
      const std::uint32_t points = 1 + below(6);
      const std::uint32_t true_label = below(4) << 16U | ids[below(5)];
      const std::uint32_t found_label = below(2) == 0 ? true_label : below(4) << 16U | ids[below(5)];
      truth.insert(truth.end(), points, true_label);
      found.insert(found.end(), points, found_label);
    }
    quality.addScan(found.data(), truth.data(), truth.size());
    for (const TrueObject& object : errors.judge(quality.lastScan())) counts.add(object.outcome);
  }
  std::uint64_t false_negatives = 0;
  for (std::size_t c = 0; c < quality.classes().size(); ++c)
    if (quality.table()[static_cast<ClassIndex>(c)].isThing()) false_negatives += quality.classes()[c].fn;
  EXPECT_EQ(counts.split + counts.merged + counts.missed, false_negatives);
  EXPECT_GT(counts.split, 0U);
  EXPECT_GT(counts.merged, 0U);
  EXPECT_GT(counts.matched, 0U);
}
}  // namespace lidar_panoptic_clustering
