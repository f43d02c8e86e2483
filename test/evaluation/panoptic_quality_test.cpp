#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"

#include "brute_force_panoptic_quality.h"
#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"
#include "recorded_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
using Labels = std::vector<std::uint32_t>;

std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

std::uint32_t label(std::uint32_t class_id, std::uint32_t instance)
{
  return instance << 16U | class_id;
}

void add(PanopticQuality& quality, const Labels& predicted, const Labels& truth)
{
  quality.addScan(predicted.data(), truth.data(), truth.size());
}

const ClassCounts& countsOf(const PanopticQuality& quality, const std::string& name)
{
  return quality.classes()[quality.table().findByName(name)];
}

/// Random segments in random order; the prediction mostly repeats the truth. The ids: ignored, two of one class, a
/// thing alone, two of one stuff class, stuff alone, and one no table knows.
void randomScan(std::mt19937& random, Labels& predicted, Labels& truth)
{
  const Labels ids{0, 1, 52, 10, 252, 30, 40, 60, 50, 777};
  const auto below = [&](std::size_t n) { return static_cast<std::uint32_t>(random() % n); };
  const auto anyLabel = [&] { return label(ids[below(ids.size())], below(3)); };
  truth.clear(), predicted.clear();
  for (std::uint32_t run = 0; run < 20; ++run)
  {
    const std::uint32_t true_label = anyLabel();
    const std::uint32_t predicted_label = below(3) == 0 ? anyLabel() : true_label;
    const std::uint32_t points = 1 + below(8);
    truth.insert(truth.end(), points, true_label);
    predicted.insert(predicted.end(), points, predicted_label);
  }
}

Labels readLabels(const std::filesystem::path& path)
{
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  Labels labels(bytes.size() / sizeof(std::uint32_t));
  std::copy(bytes.begin(), bytes.begin() + static_cast<long>(labels.size() * 4),
            reinterpret_cast<char*>(labels.data()));
  return labels;
}

PanopticQuality evaluateRecorded(const std::string& set, const std::filesystem::path& root,
                                 const std::vector<std::string>& sequences)
{
  PanopticQuality quality(kitti());
  for (const std::string& sequence : sequences)
    for (const auto& entry : std::filesystem::directory_iterator(root / "sequences" / sequence / "labels"))
      add(quality,
          readLabels(root / "predictions" / set / "sequences" / sequence / "predictions" / entry.path().filename()),
          readLabels(entry.path()));
  return quality;
}
}  // namespace

TEST(PanopticQuality, EmptyIsZero)
{
  PanopticQuality quality(kitti());
  add(quality, {}, {});
  EXPECT_EQ(quality.scanCount(), 1U);
  EXPECT_EQ(quality.figures().pq, 0.0);
  EXPECT_EQ(quality.figures().miou, 0.0);
  EXPECT_EQ(quality.figures().pq_th_present, 0.0);
}

TEST(PanopticQuality, LiteralScan)
{
  // a car of 4 points found with 3 and one too many, a person taken for a car, a stuff point without truth
  const Labels truth{label(10, 1), label(10, 1), label(10, 1), label(10, 1), 40, label(30, 2), 0};
  const Labels found{label(10, 7), label(10, 7), label(10, 7), 40, label(10, 7), label(10, 8), 40};
  PanopticQuality quality(kitti(), 1);
  add(quality, found, truth);

  const ClassCounts car = countsOf(quality, "car");
  EXPECT_EQ(car.tp, 1U);
  EXPECT_EQ(car.fp, 1U);
  EXPECT_EQ(car.fn, 0U);
  EXPECT_DOUBLE_EQ(car.sq(), 0.6);
  EXPECT_DOUBLE_EQ(car.rq(), 1 / 1.5);
  EXPECT_DOUBLE_EQ(car.iou(), 3.0 / 6.0);
  EXPECT_EQ(countsOf(quality, "person").fn, 1U);
  EXPECT_EQ(countsOf(quality, "road").fp, 1U);
  EXPECT_EQ(countsOf(quality, "road").fn, 1U);
  EXPECT_DOUBLE_EQ(quality.figures().pq, 0.4 / 19);
  EXPECT_DOUBLE_EQ(quality.figures().pq_th, 0.4 / 8);
  EXPECT_DOUBLE_EQ(quality.figures().pq_th_present, 0.4 / 2);
}

TEST(PanopticQuality, HalfIsNoMatch)
{
  PanopticQuality quality(kitti(), 1);
  add(quality, {label(10, 1), label(10, 2)}, {label(10, 1), label(10, 1)});
  EXPECT_EQ(countsOf(quality, "car").tp, 0U);
  EXPECT_EQ(countsOf(quality, "car").fp, 2U);
  EXPECT_EQ(countsOf(quality, "car").fn, 1U);
}

TEST(PanopticQuality, SmallSegmentsAreNeverFalseButMayBeTrue)
{
  PanopticQuality quality(kitti(), 3);
  add(quality, {label(10, 1), label(10, 1), label(11, 2), label(11, 2)},
      {label(10, 5), label(10, 5), label(30, 6), label(30, 6)});
  EXPECT_EQ(countsOf(quality, "car").tp, 1U);
  EXPECT_EQ(countsOf(quality, "bicycle").fp, 0U);
  EXPECT_EQ(countsOf(quality, "person").fn, 0U);
}

TEST(PanopticQuality, EqualsBruteForce)
{
  std::mt19937 random(1);
  Labels predicted, truth;
  for (int trial = 0; trial < 300; ++trial)
  {
    const int min_points = trial % 8;
    PanopticQuality quality(kitti(), min_points);
    BruteForcePanopticQuality expected(*kitti(), static_cast<std::size_t>(min_points));
    for (int scan = 0; scan < 3; ++scan)
    {
      randomScan(random, predicted, truth);
      add(quality, predicted, truth);
      expected.add(predicted, truth);
    }
    for (std::size_t c = 0; c < kitti()->size(); ++c)
    {
      const auto index = static_cast<ClassIndex>(c);
      ClassCounts counts = quality.classes()[c];
      ASSERT_NEAR(counts.iou_sum.value(), expected.iou_sum[index], 1e-12);
      counts.iou_sum = {};
      ASSERT_TRUE(counts == expected.counts[index]) << "trial " << trial << ", " << (*kitti())[index].name;
    }
  }
}

TEST(PanopticQuality, SeparateArraysGiveTheSame)
{
  std::mt19937 random(2);
  Labels predicted, truth;
  randomScan(random, predicted, truth);
  Labels classes, instances, true_classes, true_instances;
  for (std::size_t i = 0; i < truth.size(); ++i)
  {
    classes.push_back(predicted[i] & 0xFFFFU), instances.push_back((predicted[i] >> 16U) + 70000U);
    true_classes.push_back(truth[i] & 0xFFFFU), true_instances.push_back((truth[i] >> 16U) + 4294900000U);
  }
  PanopticQuality packed(kitti(), 2), mixed(kitti(), 2), separate(kitti(), 2);
  add(packed, predicted, truth);
  const auto predicted_labels = ScanLabels::separate(classes.data(), instances.data());
  mixed.addScan(predicted_labels, ScanLabels::packed(truth.data()), truth.size());
  separate.addScan(predicted_labels, ScanLabels::separate(true_classes.data(), true_instances.data()), truth.size());
  EXPECT_TRUE(packed == mixed);
  EXPECT_TRUE(packed == separate);
}

TEST(PanopticQuality, MergedPartsEqualTheWholeInAnyOrder)
{
  std::mt19937 random(3);
  PanopticQuality whole(kitti(), 4);
  std::vector<PanopticQuality> parts(5, whole);
  Labels predicted, truth;
  for (std::size_t scan = 0; scan < 500; ++scan)
  {
    randomScan(random, predicted, truth);
    add(whole, predicted, truth);
    add(parts[scan % parts.size()], predicted, truth);
  }
  for (int order = 0; order < 10; ++order)
  {
    std::shuffle(parts.begin(), parts.end(), random);
    PanopticQuality sum(kitti(), 4);
    for (const PanopticQuality& part : parts) sum += part;
    ASSERT_TRUE(sum == whole);
    ASSERT_EQ(toJson(sum).dump(), toJson(whole).dump());
  }
}

TEST(PanopticQuality, RefusesToMergeOtherRules)
{
  PanopticQuality quality(kitti(), 50);
  EXPECT_THROW(quality += PanopticQuality(kitti(), 49), std::invalid_argument);
  const auto nuscenes = std::make_shared<const ClassTable>(ClassTable::load("nuscenes"));
  EXPECT_THROW(quality += PanopticQuality(nuscenes, 50), std::invalid_argument);
  EXPECT_THROW(PanopticQuality(kitti(), -1), std::invalid_argument);
  EXPECT_THROW(PanopticQuality(nullptr), std::invalid_argument);
}

TEST(ExactSum, IsExact)
{
  ExactSum sum;
  for (int i = 0; i < 3; ++i) sum.add(1.0);
  for (int i = 0; i < 4; ++i) sum.add(0.75);
  EXPECT_EQ(sum.whole, 6U);
  EXPECT_EQ(sum.fraction, 0U);
  sum.add(std::nextafter(0.5, 1.0));
  EXPECT_EQ(sum.fraction, (std::uint64_t{1} << 52U) + 1U);
}

TEST(PairIndex, NumbersPairsByFirstAppearance)
{
  std::mt19937_64 random(4);
  PairIndex index;
  for (int round = 0; round < 3; ++round)
  {
    index.clear();
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> expected;
    for (int i = 0; i < 20000; ++i)
    {
      const std::uint64_t a = random() % 60 << (16 * round), b = random() % 60 << (32 - 16 * round);
      const auto number = static_cast<std::uint32_t>(expected.size());
      ASSERT_EQ(index.indexOf(a, b), expected.emplace(std::make_pair(a, b), number).first->second);
    }
    ASSERT_EQ(index.size(), expected.size());
  }
}

class OfficialFigures : public testing::TestWithParam<const char*>
{
};

TEST_P(OfficialFigures, AreReproduced)
{
  REQUIRE_RECORDED_DATA(folder);
  const std::filesystem::path root = std::filesystem::path(folder) / "semantickitti";
  std::ifstream file(root / "expected_panoptic_quality.json");
  const auto expected = nlohmann::json::parse(file).at(GetParam());
  const auto found = toJson(evaluateRecorded(GetParam(), root, {"00", "05", "07"}));

  ASSERT_EQ(expected.at("per_class").size(), 19U);
  for (const auto& [key, value] : expected.items())
  {
    if (key == "per_class") continue;
    EXPECT_NEAR(found.at(key).get<double>(), value.get<double>(), 1e-9) << key;
  }
  for (const auto& [name, figures] : expected.at("per_class").items())
    for (const auto& [key, value] : figures.items())
      EXPECT_NEAR(found.at("per_class").at(name).at(key).get<double>(), value.get<double>(), 1e-9)
          << name << " " << key;
}

INSTANTIATE_TEST_SUITE_P(SemanticKitti, OfficialFigures, testing::Values("mininet", "perturbed"));

TEST(PanopticQuality, RecordedSequencesMergeToTheWhole)
{
  REQUIRE_RECORDED_DATA(folder);
  const std::filesystem::path root = std::filesystem::path(folder) / "semantickitti";
  PanopticQuality sum = evaluateRecorded("perturbed", root, {"07"});
  sum += evaluateRecorded("perturbed", root, {"00", "05"});
  EXPECT_TRUE(sum == evaluateRecorded("perturbed", root, {"00", "05", "07"}));
}
}  // namespace lidar_panoptic_clustering
