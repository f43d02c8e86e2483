// What holds for every algorithm, whatever its rule.
#include "scan_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
class EveryAlgorithm : public testing::TestWithParam<std::string>
{
protected:
  PanopticCloud run(const LabelledCloud& cloud, const ParameterMap& parameters = {}) const
  {
    return runAlgorithm(GetParam(), cloud, parameters);
  }
};

bool isThing(const LabelledPoint& p)
{
  const bool returned = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
                        (p.x != 0.0F || p.y != 0.0F || p.z != 0.0F) && std::hypot(p.x, p.y, p.z) <= 300.0F;
  return returned && (*kittiTable())[kittiTable()->find(p.label)].isThing();
}

/// A vote may change a thing's label to the canonical one of a class of its group.
void expectVotedWithinGroup(const LabelledPoint& from, const PanopticPoint& to)
{
  const ClassInfo& before = (*kittiTable())[kittiTable()->find(from.label)];
  const ClassInfo& after = (*kittiTable())[kittiTable()->find(to.label)];
  ASSERT_NE(to.instance, 0U);
  ASSERT_NE(before.name, after.name);
  ASSERT_EQ(before.group, after.group);
  ASSERT_EQ(to.label, after.ids[0]);
}

/// Same points as the input, ids on all valid things and on nothing else, 1..n by first pixel.
void expectSound(const LabelledCloud& in, const PanopticCloud& out)
{
  ASSERT_EQ(out.points.size(), in.points.size());
  EXPECT_EQ(out.width, in.width);
  EXPECT_EQ(out.height, in.height);
  EXPECT_EQ(out.header.frame_id, in.header.frame_id);
  EXPECT_EQ(out.header.stamp, in.header.stamp);
  EXPECT_EQ(out.header.seq, in.header.seq);
  std::uint32_t largest = 0;
  std::map<std::uint32_t, ClassIndex> class_of_instance;
  for (std::size_t i = 0; i < in.points.size(); ++i)
  {
    const auto& from = in.points[i];
    const auto& to = out.points[i];
    ASSERT_EQ(std::memcmp(from.data, to.data, 3 * sizeof(float)), 0) << i;
    if (to.label != from.label) expectVotedWithinGroup(from, to);
    ASSERT_EQ(std::memcmp(&from.intensity, &to.intensity, sizeof(float)), 0);
    ASSERT_EQ(to.instance != 0, isThing(from)) << i;
    if (to.instance == 0) continue;
    ASSERT_LE(to.instance, largest + 1) << i;
    largest = std::max(largest, to.instance);
    const ClassIndex class_index = kittiTable()->find(to.label);
    ASSERT_EQ(class_of_instance.emplace(to.instance, class_index).first->second, class_index);
  }
}

TEST_P(EveryAlgorithm, keepsThePointsAndNumbersTheThings)
{
  for (unsigned seed = 0; seed < 30; ++seed)
  {
    LabelledCloud cloud = randomScan(seed, 1 + seed % 33, 1 + 13 * seed % 200);
    cloud.header.frame_id = "velodyne", cloud.header.stamp = 1234567890123456 + seed, cloud.header.seq = seed;
    for (auto& p : cloud.points) p.intensity = 0.25F;
    expectSound(cloud, run(cloud));
  }
}

TEST_P(EveryAlgorithm, acceptsCloudsWithoutThings)
{
  expectSound(LabelledCloud(), run(LabelledCloud()));
  const LabelledCloud all_nan(64, 32, labelled(kNoReturn, kNoReturn, kNoReturn, kCar));
  expectSound(all_nan, run(all_nan));
  const LabelledCloud all_zero(64, 32, labelled(0.0F, 0.0F, 0.0F, kCar));
  expectSound(all_zero, run(all_zero));
  LabelledCloud all_road = randomScan(1, 32, 64);
  for (auto& p : all_road.points) p.label = kRoad;
  expectSound(all_road, run(all_road));
}

TEST_P(EveryAlgorithm, acceptsOnePointOneRowOneColumn)
{
  const LabelledCloud one_point(1, 1, labelled(5.0F, 1.0F, 0.0F, kCar));
  EXPECT_EQ(instancesOf(run(one_point)), std::vector<std::uint32_t>{1});
  for (const auto& [rows, columns] : {std::pair{1U, 100U}, std::pair{64U, 1U}, std::pair{2U, 2U}})
    for (unsigned seed = 0; seed < 10; ++seed)
    {
      const LabelledCloud cloud = randomScan(seed, rows, columns);
      expectSound(cloud, run(cloud));
      expectSound(cloud, run(cloud, {{"field_of_view", std::string("sector")}}));
    }
}

TEST_P(EveryAlgorithm, acceptsEverythingOneClass)
{
  LabelledCloud cloud = randomScan(3, 32, 128);
  for (auto& p : cloud.points) p.label = kCar;
  expectSound(cloud, run(cloud));
}

TEST_P(EveryAlgorithm, acceptsWildCoordinatesAndLabels)
{
  LabelledCloud cloud = randomScan(4, 16, 64);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float wild[] = {kInfinity, -kInfinity, kNoReturn, 1e38F, -1e20F, 1e-38F, 299.0F, 0.0F};
  for (std::size_t i = 0; i < cloud.points.size(); i += 3)
  {
    auto& p = cloud.points[i];
    p.label = i % 2 == 0 ? kCar : 0xFFFFFFFF - static_cast<std::uint32_t>(i);
    (i % 4 == 0 ? p.x : p.y) = wild[i / 3 % std::size(wild)];
  }
  for (auto& p : cloud.points)  // a sum of squares that is neither far from 0 nor from the limit is another test's
    if (p.y == 1e-38F) p.y = 0.0F;
  const PanopticCloud out = run(cloud);
  ASSERT_EQ(out.points.size(), cloud.points.size());
  for (std::size_t i = 0; i < out.points.size(); ++i) EXPECT_EQ(out.points[i].instance != 0, isThing(cloud.points[i]));
}

TEST_P(EveryAlgorithm, staysInClassesEvenWhereTheyTouch)
{
  LabelledCloud cloud = emptyCloud(4, 64);
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i)
    cloud.points[i] =
        onBeam(4, 64, static_cast<float>(i / 64), static_cast<float>(i % 64), 3.0F, i % 2 == 0 ? kCar : kPerson);
  expectSound(cloud, run(cloud));
}

TEST_P(EveryAlgorithm, rawIdsOfAClassAreOneClass)
{
  LabelledCloud cloud = emptyCloud(4, 64);
  for (std::uint32_t i = 0; i < 32; ++i)
    cloud.points[i] = onBeam(4, 64, 0.0F, static_cast<float>(i % 8), 3.0F, i % 2 == 0 ? kCar : kMovingCar);
  LabelledCloud plain = cloud;
  for (auto& p : plain.points) p.label = p.label == kMovingCar ? kCar : p.label;
  EXPECT_EQ(instancesOf(run(cloud)), instancesOf(run(plain)));
}

TEST_P(EveryAlgorithm, isTheSameTwice)
{
  Algorithm made = makeAlgorithm(GetParam());
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    const LabelledCloud cloud = randomScan(seed, 16, 100);
    PanopticCloud first, second;
    pipeline.segment(cloud), pipeline.paint(cloud, first);
    pipeline.segment(cloud), pipeline.paint(cloud, second);
    EXPECT_EQ(instancesOf(first), instancesOf(second));
    EXPECT_EQ(instancesOf(first), instancesOf(run(cloud))) << "a used pipeline differs from a new one";
  }
}

std::string pixelName(const PanopticCloud& cloud, std::size_t i)
{
  return "(row " + std::to_string(i / cloud.width) + ", column " + std::to_string(i % cloud.width) + ")";
}

/// Where `moved[i]` holds what was at pixel source(i): the partition must have moved along. `hint` says what a rule
/// that fails here may have overlooked.
void expectSamePartition(const PanopticCloud& original, const PanopticCloud& moved,
                         const std::function<std::size_t(std::size_t)>& source, const std::string& hint)
{
  std::map<std::uint32_t, std::size_t> first_of_original, first_of_moved;  // by instance: its first pixel in `moved`
  for (std::size_t i = 0; i < moved.points.size(); ++i)
  {
    const std::uint32_t before = original.points[source(i)].instance, after = moved.points[i].instance;
    ASSERT_EQ(before != 0, after != 0) << pixelName(moved, i) << " has an instance in one of the two scans only";
    if (after == 0) continue;
    const std::size_t with_before = first_of_original.emplace(before, i).first->second;
    const std::size_t with_after = first_of_moved.emplace(after, i).first->second;
    if (with_before == with_after) continue;
    const bool was_one = with_before != i && moved.points[with_before].instance != after;
    const std::size_t other = was_one ? with_before : with_after;
    FAIL() << "the points at " << pixelName(original, source(other)) << " and " << pixelName(original, source(i))
           << " are " << (was_one ? "one instance" : "two instances") << " in the scan, but "
           << (was_one ? "two" : "one") << " where it is moved, there at " << pixelName(moved, other) << " and "
           << pixelName(moved, i) << ". " << hint;
  }
}

constexpr char kRotated[] =
    "Only the columns' numbers changed, so the rule depends on where a row begins: where ThingScan::full_turn is set, "
    "the last column is the first one's neighbour";
constexpr char kMirrored[] =
    "Only the rows' order changed, so the rule depends on which scan line comes first, as a search that looks at the "
    "lines above only would";

TEST_P(EveryAlgorithm, mirroredRowsGiveTheSamePartition)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const LabelledCloud cloud = randomScan(seed, 16, 90);
    LabelledCloud mirrored = cloud;
    const auto source = [&](std::size_t i) { return (15 - i / 90) * 90 + i % 90; };
    for (std::size_t i = 0; i < cloud.points.size(); ++i) mirrored.points[i] = cloud.points[source(i)];
    expectSamePartition(run(cloud), run(mirrored), source, kMirrored);
  }
}

TEST_P(EveryAlgorithm, rotatedColumnsGiveTheSamePartition)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    const LabelledCloud cloud = randomScan(seed, 16, 90);
    LabelledCloud rotated = cloud;
    const auto source = [&](std::size_t i) { return i / 90 * 90 + (i + 1 + 7 * seed) % 90; };
    for (std::size_t i = 0; i < cloud.points.size(); ++i) rotated.points[i] = cloud.points[source(i)];
    expectSamePartition(run(cloud), run(rotated), source, kRotated);
  }
}

TEST_P(EveryAlgorithm, anObjectOverTheSeamIsOne)
{
  LabelledCloud cloud = emptyCloud(4, 360);
  for (std::uint32_t row = 0; row < 4; ++row)
    for (const std::uint32_t column : {357U, 358U, 359U, 0U, 1U, 2U})
      cloud.points[row * 360 + column] =
          onBeam(16, 360, static_cast<float>(row), static_cast<float>(column), 4.0F, kCar);
  const auto ids = instancesOf(run(cloud));
  EXPECT_EQ(std::set<std::uint32_t>(ids.begin(), ids.end()), (std::set<std::uint32_t>{0, 1}))
      << "an object in columns 357 to 359 and 0 to 2 of 360 is not one instance: where ThingScan::full_turn is set, "
         "the "
         "last column is the first one's neighbour";
}

TEST_P(EveryAlgorithm, refusesASizeThatContradictsThePoints)
{
  LabelledCloud cloud = randomScan(0, 4, 8);
  cloud.width = 9;
  try
  {
    run(cloud);
    FAIL() << "no error";
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_NE(std::string(error.what()).find("9 x 4"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("32 points"), std::string::npos) << error.what();
  }
}

TEST_P(EveryAlgorithm, namesTheUnknownLabels)
{
  LabelledCloud cloud = randomScan(0, 4, 8);
  cloud.points[3].label = 77777, cloud.points[5].label = 5, cloud.points[6].label = 5;
  Algorithm made = makeAlgorithm(GetParam());
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  pipeline.segment(cloud);
  EXPECT_EQ(pipeline.things().unknown_labels, (std::vector<std::uint32_t>{77777, 5}));
}

TEST_P(EveryAlgorithm, refusesParametersOutsideTheirRange)
{
  for (const auto& info : algorithmParameters(GetParam()))
  {
    if (!std::holds_alternative<int>(info.value) && !std::holds_alternative<double>(info.value)) continue;
    for (const double beyond : {info.min - 1.0, info.max + 1.0}) try
      {
        makeAlgorithm(GetParam(), {{info.name, beyond}});
        ADD_FAILURE() << info.name << " = " << beyond << " was accepted";
      }
      catch (const std::invalid_argument& error)
      {
        EXPECT_NE(std::string(error.what()).find(info.name), std::string::npos) << error.what();
      }
  }
  EXPECT_THROW(makeAlgorithm(GetParam(), {{"no_such_parameter", 1}}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, EveryAlgorithm, testing::ValuesIn(algorithmNames()),
                         [](const auto& test) { return test.param; });
}  // namespace
}  // namespace lidar_panoptic_clustering
