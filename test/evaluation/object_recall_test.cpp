#include "lidar_panoptic_clustering/evaluation/object_recall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
using Labels = std::vector<std::uint32_t>;
constexpr std::uint32_t kGround = 1, kStructure = 2, kObject = 3;
constexpr std::uint32_t kCar = 10, kPerson = 30, kRoad = 40, kBuilding = 50, kVegetation = 70;

std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// `points` points of one true label and one result.
struct Piece
{
  std::uint32_t points, true_class, true_instance, found_class, found_instance;
  float range = 5.0F;
};

struct Scan
{
  explicit Scan(const std::vector<Piece>& runs)
  {
    for (const Piece& run : runs)
      for (std::uint32_t k = 0; k < run.points; ++k)
      {
        truth.push_back(run.true_instance << 16U | run.true_class);
        found_class.push_back(run.found_class), found_instance.push_back(run.found_instance);
        range.push_back(run.range);
      }
  }
  RecallScan view() const
  {
    return {found_class.data(), found_instance.data(), ScanLabels::packed(truth.data()), range.data(), truth.size()};
  }
  Labels truth, found_class, found_instance;
  std::vector<float> range;
};

ObjectRecall recallOf(const std::vector<Piece>& runs, std::uint32_t min_points = 1)
{
  ObjectRecallConfig config;
  config.min_points = min_points;
  ObjectRecall recall(kitti(), config);
  recall.addScan(Scan(runs).view());
  return recall;
}

RecallOutcome outcomeOf(const std::vector<Piece>& runs)
{
  return recallOf(runs).objects().at(0).outcome;
}

TEST(ObjectRecall, NothingInNothingOut)
{
  const ObjectRecall recall = recallOf({});
  EXPECT_EQ(recall.all(), RecallCounts());
  EXPECT_EQ(recall.scanCount(), 1U);
  EXPECT_EQ(recall.ground().iou(), 0.0);
}

TEST(ObjectRecall, TheClassDoesNotMatterAndTheThresholdsAreStrict)
{
  // IoU 0.5 is not above it, 6/10 is, 7/10 is not above 0.7, 8/10 is
  for (const auto& [inside, iou_50, iou_70] : {std::tuple{5U, 0U, 0U}, {6U, 1U, 0U}, {7U, 1U, 0U}, {8U, 1U, 1U}})
  {
    const ObjectRecall recall = recallOf(
        {{inside, kPerson, 1, kObject, 9}, {10 - inside, kPerson, 1, kStructure, 0}, {5, kRoad, 0, kGround, 0}});
    EXPECT_EQ(recall.all().objects, 1U);
    EXPECT_EQ(recall.all().iou_50, iou_50) << inside;
    EXPECT_EQ(recall.all().iou_70, iou_70) << inside;
  }
}

TEST(ObjectRecall, Outcomes)
{
  EXPECT_EQ(outcomeOf({{6, kCar, 1, kObject, 1}, {4, kCar, 1, kStructure, 0}}), RecallOutcome::kFound);
  EXPECT_EQ(outcomeOf({{4, kCar, 1, kObject, 1}, {6, kCar, 1, kStructure, 0}}), RecallOutcome::kLost);
  EXPECT_EQ(outcomeOf({{10, kCar, 1, kObject, 1}, {11, kBuilding, 0, kObject, 1}}), RecallOutcome::kMerged);
  EXPECT_EQ(outcomeOf({{5, kCar, 1, kObject, 1}, {5, kCar, 1, kObject, 2}}), RecallOutcome::kSplit);
  EXPECT_EQ(outcomeOf({{5, kCar, 1, kObject, 1}, {5, kCar, 1, kStructure, 0}}), RecallOutcome::kCut);
}

TEST(ObjectRecall, ThingsWithoutAnInstanceAndSmallOnesAreNoObjects)
{
  const ObjectRecall recall = recallOf({{60, kCar, 0, kObject, 1}, {49, kCar, 1, kObject, 2}, {50, kCar, 2, 3, 3}}, 50);
  EXPECT_EQ(recall.all().objects, 1U);
  EXPECT_EQ(recall.falseSegments(), 0U) << "a thing of no instance is no stuff";
}

TEST(ObjectRecall, FalseSegmentsLieMostlyOnNoThing)
{
  const ObjectRecall recall = recallOf({{60, kBuilding, 0, kObject, 1},
                                        {30, kVegetation, 0, kObject, 2},
                                        {30, kCar, 1, kObject, 2},
                                        {31, 1, 0, kObject, 3},
                                        {30, kCar, 2, kObject, 3},
                                        {49, kBuilding, 0, kObject, 4}},
                                       50);
  EXPECT_EQ(recall.falseSegments(), 2U) << "half is not most, outliers are no thing, 49 points are too few";
  EXPECT_EQ(recall.falsePoints(), 60U + 61U);
}

TEST(ObjectRecall, GroundLeavesOutWhatTheTruthDoesNotTell)
{
  const ObjectRecall recall = recallOf({{8, kRoad, 0, kGround, 0},
                                        {2, 72, 0, kStructure, 0},
                                        {4, kBuilding, 0, kGround, 0},
                                        {100, 0, 0, kGround, 0},
                                        {100, 1, 0, kGround, 0},
                                        {100, kVegetation, 0, kGround, 0}});
  EXPECT_DOUBLE_EQ(recall.ground().precision(), 8.0 / 12.0);
  EXPECT_DOUBLE_EQ(recall.ground().recall(), 8.0 / 10.0);
  EXPECT_DOUBLE_EQ(recall.ground().iou(), 8.0 / 14.0);
}

TEST(ObjectRecall, ClassesAndRanges)
{
  const ObjectRecall recall =
      recallOf({{5, kCar, 1, 3, 1, 9.9F}, {5, kCar, 2, 2, 0, 10.0F}, {5, kPerson, 3, 3, 2, 60.0F}});
  EXPECT_EQ(recall.byClass().at("car").objects, 2U);
  EXPECT_EQ(recall.byClass().at("car").lost, 1U);
  EXPECT_EQ(recall.byClass().at("person").iou_70, 1U);
  EXPECT_EQ(recall.byRange()[0].iou_50, 1U);
  EXPECT_EQ(recall.byRange()[1].lost, 1U);
  EXPECT_EQ(recall.byRange()[4].objects, 1U);
}

TEST(ObjectRecall, Entropies)
{
  const ObjectRecall recall = recallOf({{4, kCar, 1, 3, 1}, {4, kCar, 1, 2, 0}, {12, kRoad, 0, 3, 1}});
  EXPECT_NEAR(recall.overSegmentation(), std::log(2.0), 1e-12) << "half in a segment, half in none";
  EXPECT_NEAR(recall.underSegmentation(), -0.25 * std::log(0.25) - 0.75 * std::log(0.75), 1e-12);
}

/// The rules of the header, point by point.
struct BruteForce
{
  std::uint64_t objects = 0, iou_50 = 0, iou_70 = 0, lost = 0, false_segments = 0, false_points = 0;

  void add(const Scan& scan, std::size_t min_points)
  {
    const std::size_t n = scan.truth.size();
    const auto thing = [&](std::size_t i) { return kitti()->kindOf(scan.truth[i] & 0xFFFFU) == ClassKind::kThing; };
    std::set<std::uint32_t> labels(scan.truth.begin(), scan.truth.end());
    std::set<std::uint32_t> segments(scan.found_instance.begin(), scan.found_instance.end());
    for (const std::uint32_t label : labels)
    {
      std::size_t size = 0, in_none = 0;
      bool is_object = label >> 16U != 0;
      for (std::size_t i = 0; i < n; ++i)
        if (scan.truth[i] == label) ++size, is_object &= thing(i), in_none += scan.found_instance[i] == 0 ? 1 : 0;
      if (!is_object || size < min_points) continue;
      double best = 0.0;
      for (const std::uint32_t segment : segments)
      {
        double both = 0, either = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
          const bool a = scan.truth[i] == label, b = segment != 0 && scan.found_instance[i] == segment;
          both += a && b ? 1 : 0, either += a || b ? 1 : 0;
        }
        best = std::max(best, both / either);
      }
      ++objects, iou_50 += best > 0.5 ? 1U : 0U, iou_70 += best > 0.7 ? 1U : 0U;
      lost += best <= 0.5 && 2 * in_none > size ? 1U : 0U;
    }
    for (const std::uint32_t segment : segments)
    {
      std::size_t size = 0, things = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (segment != 0 && scan.found_instance[i] == segment) ++size, things += thing(i) ? 1 : 0;
      if (size < min_points || 2 * (size - things) <= size) continue;
      ++false_segments, false_points += size;
    }
  }
};

TEST(ObjectRecall, FlipsAreObjectsFoundInOneOfTwoScansInARow)
{
  ObjectRecallConfig config;
  config.min_points = 5;
  ObjectRecall recall(kitti(), config);
  const auto add = [&recall](bool first_is_found, bool follows, std::uint32_t third_points)
  {
    const Scan scan({{10, kCar, 1, kObject, first_is_found ? 1U : 0U},
                     {10, kCar, 2, kObject, 2},
                     {third_points, kPerson, 1, kObject, 0}});
    RecallScan view = scan.view();
    view.follows = follows;
    recall.addScan(view);
  };
  add(true, false, 4);
  EXPECT_EQ(recall.shownTwice(), 0U);
  add(false, true, 9);  // the first car flips; the person was too small before
  EXPECT_EQ(recall.shownTwice(), 2U);
  EXPECT_EQ(recall.flips(), 1U);
  add(true, false, 9);  // another sequence
  EXPECT_EQ(recall.shownTwice(), 2U);
  add(true, true, 9);
  EXPECT_EQ(recall.shownTwice(), 5U);
  EXPECT_EQ(recall.flips(), 1U);
  EXPECT_NE(formatObjectRecall(recall).find("Flips: 1 of 5 objects"), std::string::npos);
  recall += recall;
  EXPECT_EQ(recall.flips(), 2U);
}

TEST(ObjectRecall, EqualsBruteForceOnRandomScansAndAddsUp)
{
  std::mt19937 random(3);
  const auto draw = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  ObjectRecallConfig config;
  config.min_points = 8;
  ObjectRecall whole(kitti(), config), first(kitti(), config), second(kitti(), config);
  BruteForce brute;
  for (int round = 0; round < 60; ++round)
  {
    std::vector<Piece> runs;
    for (int k = 0; k < 40; ++k)
    {
      const std::uint32_t classes[] = {kCar, kPerson, kRoad, kBuilding, 0, kVegetation};
      const std::uint32_t id = classes[draw(6)], instance = id <= kPerson ? draw(4) : 0;
      // mostly each true object has a segment of its own
      const std::uint32_t segment = draw(8) == 0 ? draw(9) : instance == 0 ? 0 : instance + (id == kCar ? 0 : 4);
      runs.push_back({1 + draw(9), id, instance, segment > 0 ? kObject : 1 + draw(2), segment});
    }
    const Scan scan(runs);
    whole.addScan(scan.view());
    (round % 2 == 0 ? first : second).addScan(scan.view());
    brute.add(scan, config.min_points);
  }
  first += second;
  for (const ObjectRecall* recall : {&whole, &first})
  {
    EXPECT_GT(recall->all().iou_50, 5U);
    EXPECT_EQ(recall->all().objects, brute.objects);
    EXPECT_EQ(recall->all().iou_50, brute.iou_50);
    EXPECT_EQ(recall->all().iou_70, brute.iou_70);
    EXPECT_EQ(recall->all().lost, brute.lost);
    EXPECT_EQ(recall->falseSegments(), brute.false_segments);
    EXPECT_EQ(recall->falsePoints(), brute.false_points);
    const RecallCounts& all = recall->all();
    EXPECT_EQ(all.objects, all.iou_50 + all.lost + all.merged + all.split + all.cut);
  }
  EXPECT_EQ(first.scanCount(), 60U);
  config.min_points = 9;
  EXPECT_THROW(first += ObjectRecall(kitti(), config), std::invalid_argument);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
