// Clouds that are not organised, placed by ring, by beams and by unfolding, give what the organised original gives.
#include "lidar_panoptic_clustering/projection/original_labeller.h"
#include "scan_fixture.h"
#include "unordered_clouds.h"

#include <gtest/gtest.h>

#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
OrganizerConfig sensorConfig(const std::string& sensor, const std::string& layout = "auto")
{
  OrganizerConfig config;
  config.layout = layout;
  config.sensor = sensor;
  return config;
}

void expectEveryPointListedOnce(const OrganizedScan& scan)
{
  const Projection& image = scan.image;
  ASSERT_EQ(image.pixel_of_point.size(), scan.points.size());
  ASSERT_EQ(image.points.size(), scan.points.size());
  ASSERT_EQ(image.cloud.points.size(), image.owner_of_pixel.size());
  ASSERT_EQ(image.cloud.points.size(), std::size_t{image.cloud.width} * image.cloud.height);
  ASSERT_EQ(image.begin.size(), image.owner_of_pixel.size() + 1);
  ASSERT_EQ(image.begin.back(), scan.points.size());
  std::vector<int> seen(scan.points.size(), 0);
  for (std::uint32_t pixel = 0; pixel < image.owner_of_pixel.size(); ++pixel)
    for (auto i = image.begin[pixel]; i < image.begin[pixel + 1]; ++i)
    {
      ASSERT_EQ(image.pixel_of_point[image.points[i]], pixel);
      ++seen[image.points[i]];
    }
  for (const int times : seen) ASSERT_EQ(times, 1);
}

/// The image is the original: the same returns in the same pixels. The simulator's columns are the organizer's.
void expectSameImage(const OrganizedScan& scan, const LabelledCloud& original)
{
  ASSERT_EQ(scan.image.cloud.height, original.height);
  ASSERT_EQ(scan.image.cloud.width, original.width);
  for (std::size_t i = 0; i < original.size(); ++i)
  {
    const auto &p = original.points[i], &q = scan.image.cloud.points[i];
    ASSERT_EQ(hasReturn(p), hasReturn(q)) << i;
    if (!hasReturn(p)) continue;
    ASSERT_TRUE(p.x == q.x && p.y == q.y && p.z == q.z && p.label == q.label) << i;
  }
}

/// The instances of the points of a scan, in the order of the original's pixels, by first occurrence.
std::vector<std::uint32_t> partition(const OrganizedScan& scan, const Order& order, const std::string& algorithm)
{
  std::vector<std::uint32_t> label, instance;
  OriginalLabeller(kittiTable()).carryBack(scan, runAlgorithm(algorithm, scan.image.cloud), label, instance);
  std::vector<std::uint32_t> by_pixel;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) pairs.emplace_back(order[i], instance[i]);
  std::sort(pairs.begin(), pairs.end());
  for (const auto& pair : pairs) by_pixel.push_back(pair.second);
  return canonical(by_pixel);
}

class EverySensor : public testing::TestWithParam<std::string>
{
};

TEST_P(EverySensor, IsPlacedByItsRingsInAnyOrderAndNumbering)
{
  const auto original = simulatedScan(GetParam());
  const Order returns = returnsOf(original);
  for (const Rings rings : {Rings::kFromTheTop, Rings::kFromTheBottom, Rings::kInBlocks, Rings::kAsFired})
    for (const Order& order : {returns, byFiring(returns, original.width), shuffled(returns)})
    {
      const auto scan = organized(oneRow(original, order, rings), sensorConfig(GetParam()));
      EXPECT_EQ(scan.layout, Layout::kRing);
      EXPECT_FALSE(scan.organized_input);
      expectEveryPointListedOnce(scan);
      expectSameImage(scan, original);
    }
}

TEST_P(EverySensor, IsPlacedByItsBeams)
{
  const auto original = simulatedScan(GetParam());
  for (const Order& order : {byFiring(returnsOf(original), original.width), shuffled(returnsOf(original))})
  {
    const auto scan = organized(oneRow(original, order, Rings::kNone), sensorConfig(GetParam()));
    EXPECT_EQ(scan.layout, Layout::kBeams);
    expectEveryPointListedOnce(scan);
    expectSameImage(scan, original);
  }
}

TEST_P(EverySensor, IsUnfoldedWhereItsPointsComeRingAfterRing)
{
  const auto original = simulatedScan(GetParam());
  const Order order = asKittiHasIt(returnsOf(original), original);
  const auto scan = organized(oneRow(original, order, Rings::kNone), sensorConfig(GetParam(), "unfold"));
  EXPECT_EQ(scan.layout, Layout::kUnfold);
  expectEveryPointListedOnce(scan);
  // beams that see nothing have no ring in the file; what comes below is a row higher then, and as good
  std::set<std::uint32_t> rows;
  for (const std::uint32_t pixel : order) rows.insert(pixel / original.width);
  EXPECT_EQ(organized(oneRow(original, order, Rings::kNone)).layout, Layout::kUnfold) << "without a sensor's name";
  EXPECT_EQ(organized(oneRow(original, order, Rings::kNone)).image.cloud.height, rows.size());
  if (rows.size() == original.height) expectSameImage(scan, original);
}

TEST_P(EverySensor, GivesThePartitionOfTheOrganisedOriginal)
{
  const auto original = simulatedScan(GetParam());
  const Order returns = returnsOf(original), kitti = asKittiHasIt(returns, original);
  const Order mixed = shuffled(returns);
  for (const char* algorithm : {"depth", "scan_line_run", "birds_eye"})
  {
    const auto painted = runAlgorithm(algorithm, original);
    std::vector<std::uint32_t> expected;
    for (const std::uint32_t pixel : returns) expected.push_back(painted.points[pixel].instance);
    expected = canonical(expected);
    ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 5U);
    const auto config = sensorConfig(GetParam());
    EXPECT_EQ(partition(organized(oneRow(original, mixed, Rings::kFromTheBottom), config), mixed, algorithm), expected);
    EXPECT_EQ(partition(organized(oneRow(original, mixed, Rings::kNone), config), mixed, algorithm), expected);
    EXPECT_EQ(partition(organized(oneRow(original, kitti, Rings::kNone), config), kitti, algorithm), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EverySensor, testing::ValuesIn(SensorModel::shippedNames()),
                         [](const auto& test) { return test.param; });

TEST(OrganizerUnordered, FindsRowsAndColumnsByItself)
{
  const auto original = simulatedScan("hdl64e");
  const Order order = shuffled(returnsOf(original));
  const auto scan = organized(oneRow(original, order, Rings::kFromTheBottom));
  EXPECT_EQ(scan.image.cloud.height, 64U);
  EXPECT_EQ(scan.image.cloud.width, 2048U);

  // a sector, and every other firing: what is left of a line tells the spacing
  Order sector, sparse;
  for (const std::uint32_t pixel : order)
  {
    if (pixel % 2048 > 900 && pixel % 2048 < 1200) sector.push_back(pixel);
    if (pixel % 2 == 0) sparse.push_back(pixel);
  }
  EXPECT_EQ(organized(oneRow(original, sector, Rings::kFromTheTop)).image.cloud.width, 2048U);
  EXPECT_EQ(organized(oneRow(original, sparse, Rings::kFromTheTop)).image.cloud.width, 1024U);

  OrganizerConfig config;
  config.columns = 360;
  EXPECT_EQ(organized(oneRow(original, order, Rings::kFromTheTop), config).image.cloud.width, 360U);
}

TEST(OrganizerUnordered, PointsWithoutAReturnAreKeptAndOwnNothing)
{
  auto original = simulatedScan("vlp16");
  Order all(original.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto message = oneRow(original, byFiring(all, original.width), Rings::kFromTheBottom);
  const auto scan = organized(message, sensorConfig("vlp16"));
  expectEveryPointListedOnce(scan);
  expectSameImage(scan, original);
}

TEST(OrganizerUnordered, HiddenPointsGetTheLabelOfTheirObject)
{
  const auto original = simulatedScan("hdl64e");
  const Order order = shuffled(returnsOf(original));
  OrganizerConfig config;
  config.columns = 512;  // three of four points are hidden
  const auto scan = organized(oneRow(original, order, Rings::kFromTheBottom), config);
  const auto clustered = runAlgorithm("birds_eye", scan.image.cloud);
  std::vector<std::uint32_t> label, instance;
  OriginalLabeller(kittiTable()).carryBack(scan, clustered, label, instance);
  std::size_t things = 0, hidden = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const bool thing = (*kittiTable())[kittiTable()->find(original.points[order[i]].label)].isThing();
    ASSERT_EQ(instance[i] > 0, thing) << i;
    ASSERT_TRUE(thing || label[i] == original.points[order[i]].label) << i;
    things += thing;
    hidden += thing && scan.image.owner_of_pixel[scan.image.pixel_of_point[i]] != i;
  }
  EXPECT_GT(2 * hidden, things);
}

/// A tracker's ids have gaps, and one that it has not given yet is no hidden object's.
TEST(OrganizerUnordered, HiddenPointsGetTheTrackOfTheirObject)
{
  const auto original = simulatedScan("hdl64e");
  OrganizerConfig config;
  config.columns = 512;  // three of four points are hidden
  const auto scan = organized(oneRow(original, shuffled(returnsOf(original)), Rings::kFromTheBottom), config);
  PanopticCloud clustered = runAlgorithm("birds_eye", scan.image.cloud);
  std::vector<std::uint32_t> label, instance, tracked_label, track;
  OriginalLabeller(kittiTable()).carryBack(scan, clustered, label, instance);
  std::uint32_t largest = 0;
  for (const auto& point : clustered.points) largest = std::max(largest, point.instance);
  constexpr std::uint32_t kApart = 10000019;
  for (auto& point : clustered.points) point.instance *= kApart;
  OriginalLabeller(kittiTable(), true).carryBack(scan, clustered, tracked_label, track);
  EXPECT_EQ(tracked_label, label);
  std::size_t own = 0;
  for (std::size_t i = 0; i < instance.size(); ++i)
  {
    const bool is_own = instance[i] > largest;
    ASSERT_EQ(track[i], is_own ? OriginalLabeller::kNoTrack + instance[i] - largest : kApart * instance[i]) << i;
    own += is_own;
  }
  RecordProperty("hidden_objects_points", static_cast<int>(own));
}

TEST(OrganizerUnordered, LayoutsThatCannotBeSayWhy)
{
  const auto original = simulatedScan("vlp16");
  const auto message = oneRow(original, shuffled(returnsOf(original)), Rings::kNone);
  EXPECT_NE(errorOf([&] { organized(message); })
                .find("points with x float32, y float32, z float32, label uint32: switch "
                      "on organised output in the driver (velodyne_pointcloud: "
                      "organize_cloud:=true; rslidar_sdk: dense_points: false), set the parameter sensor, or set layout "
                      "to 'merged'"),
            std::string::npos);
  EXPECT_EQ(
      errorOf([&] { organized(message, sensorConfig("auto", "ring")); }),
      "expected a field 'ring', 'channel' or one named by the parameter ring_field, found x float32, y float32, z "
      "float32, label uint32");
  EXPECT_EQ(errorOf([&] { organized(message, sensorConfig("auto", "beams")); }),
            "expected a sensor for the layout 'beams' (parameter sensor), found 'auto'");
  const auto with_ring = oneRow(simulatedScan("os1_64"), returnsOf(simulatedScan("os1_64")), Rings::kFromTheTop);
  EXPECT_EQ(errorOf([&] { organized(with_ring, sensorConfig("vlp16")); }),
            "expected ring numbers below 16, the sensor's beams, found 63");
}

TEST(OrganizerMerged, PassesThePointsOnInTheirOrder)
{
  const auto original = simulatedScan("vlp16");
  const Order order = shuffled(returnsOf(original));
  const auto scan = organized(oneRow(original, order, Rings::kNone), sensorConfig("auto", "merged"));
  EXPECT_EQ(scan.layout, Layout::kMerged);
  EXPECT_TRUE(scan.organized_input);
  ASSERT_EQ(scan.image.cloud.height, 1U);
  ASSERT_EQ(scan.image.cloud.width, order.size());
  expectEveryPointListedOnce(scan);
  for (std::size_t i = 0; i < order.size(); ++i)
    ASSERT_EQ(scan.image.cloud.points[i].x, original.points[order[i]].x) << i;
  // an organised cloud of several rows too
  EXPECT_EQ(
      organized(transposed(oneRow(original, order, Rings::kNone)), sensorConfig("auto", "merged")).image.cloud.width,
      order.size());
}

TEST(OrganizerMerged, OnlyAlgorithmsOnPointsTakeIt)
{
  // two lidars side by side: one after another, row-major, firing by firing, and in no order
  const auto left = simulatedScan("vlp16", 10), right = simulatedScan("vlp16", 30);
  const Order returns = returnsOf(left);
  for (const Order& order : {returns, byFiring(returns, left.width), asKittiHasIt(returns, left), shuffled(returns)})
  {
    auto merged = organized(oneRow(left, order, Rings::kNone), sensorConfig("auto", "merged")).image.cloud;
    merged += organized(oneRow(right, returnsOf(right), Rings::kNone), sensorConfig("auto", "merged")).image.cloud;
    for (const auto& algorithm : algorithmNames())
    {
      const auto error = errorOf([&] { runAlgorithm(algorithm, merged); });
      const bool by_lines = makeAlgorithm(algorithm).clusterer->needsScanLines();
      if (algorithm == "depth" || algorithm == "scan_line_run")
      {
        EXPECT_TRUE(by_lines) << algorithm;
      }
      if (by_lines)
      {
        EXPECT_NE(error.find("expected scan lines (rows of an organised cloud), found one row of "), std::string::npos);
      }
      else
      {
        EXPECT_EQ(error, "") << algorithm;
      }
    }
  }
}

TEST(OrganizerMerged, ARealSensorOfOneScanLineIsNotTakenForIt)
{
  const auto scan = simulatedScan("hdl64e");
  for (const std::uint32_t row : {10U, 30U, 60U})
  {
    LabelledCloud line(scan.width, 1);
    std::copy_n(scan.points.begin() + row * scan.width, scan.width, line.points.begin());
    for (const auto& algorithm : algorithmNames()) EXPECT_EQ(errorOf([&] { runAlgorithm(algorithm, line); }), "");
    EXPECT_EQ(organized(oneRow(line, returnsOf(line), Rings::kFromTheTop)).image.cloud.height, 1U);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
