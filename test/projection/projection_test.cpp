#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/projection/azimuth.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"
#include "lidar_panoptic_clustering/projection/scan_unfolding.h"
#include "recorded_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr auto kNone = Projection::kNone;

ProjectionConfig config(int rows, int columns)
{
  ProjectionConfig result;
  result.rows = rows, result.columns = columns;
  return result;
}

ScanPoint polar(double degrees, float range, float z = 0.0F)
{
  const double azimuth = degrees * M_PI / 180.0;
  return {range * static_cast<float>(std::cos(azimuth)), range * static_cast<float>(std::sin(azimuth)), z, 0.5F};
}

Projection project(const std::vector<ScanPoint>& scan, int rows, int columns,
                   const std::vector<std::uint32_t>& labels = {})
{
  Projection out;
  PointProjector(config(rows, columns)).project(scan, labels, out);
  return out;
}

/// The rings of points at these azimuths [deg].
std::vector<std::uint32_t> rings(const std::vector<double>& degrees)
{
  RingCounter counter;
  std::vector<std::uint32_t> found;
  for (const double d : degrees)
    found.push_back(counter.next(static_cast<float>(std::remainder(d, 360.0) * M_PI / 180.0)));
  return found;
}

using Ids = std::vector<std::uint32_t>;

std::vector<ScanPoint> randomScan(std::mt19937& random, std::size_t size)
{
  std::uniform_real_distribution<float> coordinate(-30.0F, 30.0F);
  std::uniform_int_distribution<int> kind(0, 19);
  std::vector<ScanPoint> scan(size);
  for (auto& p : scan)
  {
    p = {coordinate(random), coordinate(random), coordinate(random) / 10.0F, 0.1F};
    const int k = kind(random);
    if (k == 0) p.x = kNan;
    if (k == 1) p.y = -kInf;
    if (k == 2) p = {0.0F, 0.0F, 0.0F, 0.0F};
    if (k == 3) p.z = 3e38F;
  }
  return scan;
}

void expectEveryPointInItsPixelsListOnce(const Projection& out, std::size_t point_count)
{
  ASSERT_EQ(out.pixel_of_point.size(), point_count);
  ASSERT_EQ(out.points.size(), point_count);
  ASSERT_EQ(out.begin.size(), out.owner_of_pixel.size() + 1);
  ASSERT_EQ(out.begin.front(), 0U);
  ASSERT_EQ(out.begin.back(), point_count);
  std::vector<int> seen(point_count, 0);
  for (std::uint32_t pixel = 0; pixel < out.owner_of_pixel.size(); ++pixel)
    for (auto i = out.begin[pixel]; i < out.begin[pixel + 1]; ++i)
    {
      ASSERT_EQ(out.pixel_of_point[out.points[i]], pixel);
      ASSERT_TRUE(i == out.begin[pixel] || out.points[i - 1] < out.points[i]) << "not in file order";
      ++seen[out.points[i]];
    }
  for (const int times : seen) ASSERT_EQ(times, 1);
}
}  // namespace

TEST(FastAzimuth, IsCloseToTheExactOneAndMonotone)
{
  float before = -4.0F;
  for (int i = 1; i < 200000; ++i)
  {
    const double exact = -M_PI + i * 2.0 * M_PI / 200000;
    const auto x = static_cast<float>(7.0 * std::cos(exact)), y = static_cast<float>(7.0 * std::sin(exact));
    const float found = fastAzimuth(x, y);
    ASSERT_NEAR(found, std::atan2(static_cast<double>(y), static_cast<double>(x)), 2.1e-6);
    ASSERT_GE(found, before);
    before = found;
  }
  EXPECT_EQ(fastAzimuth(0.0F, 0.0F), 0.0F);
}

TEST(RingCounter, StartsARingWhereTheAzimuthCrossesZero)
{
  EXPECT_EQ(rings({0, 90, 180, 270, 1, 100, 350, 20, 30}), Ids({0, 0, 0, 0, 1, 1, 1, 2, 2}));
  // a ring that sees nothing on one side, and one that jumps back by less than half a turn
  EXPECT_EQ(rings({1, 250, 355, 100, 200, 50}), Ids({0, 0, 0, 1, 1, 2}));
}

TEST(RingCounter, KeepsStepsBackWithinTheirRing)
{
  EXPECT_EQ(rings({10, 17, 10, 17, 180, 176}), Ids({0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(rings({359, 1, 90, 350, 1, 359, 2, 90}), Ids({0, 0, 0, 0, 1, 1, 1, 1})) << "steps over zero";
}

TEST(PointProjection, PlacesThreeRingsOfFivePoints)
{
  std::vector<ScanPoint> scan;
  for (const float range : {10.0F, 20.0F, 30.0F})
    for (const double degrees : {10.0, 75.0, 150.0, 225.0, 290.0}) scan.push_back(polar(degrees, range));
  const auto out = project(scan, 4, 18, Ids{10, 11, 12, 13, 14, 20, 21, 22, 23, 24, 30, 31, 32, 33, 34});

  // 20 degrees a column from straight back, clockwise: azimuth 10 is 170 degrees from there, column 8
  const Ids columns{8, 5, 1, 15, 12};
  EXPECT_EQ(out.rings, 3U);
  ASSERT_EQ(out.cloud.width, 18U);
  ASSERT_EQ(out.cloud.height, 4U);
  ASSERT_EQ(out.cloud.size(), 72U);
  EXPECT_FALSE(out.cloud.is_dense);
  for (std::uint32_t i = 0; i < 15; ++i)
  {
    const std::uint32_t pixel = i / 5 * 18 + columns[i % 5];
    EXPECT_EQ(out.pixel_of_point[i], pixel);
    EXPECT_EQ(out.owner_of_pixel[pixel], i);
    EXPECT_EQ(out.cloud.points[pixel].label, 10 * (i / 5 + 1) + i % 5);
    EXPECT_EQ(out.cloud.points[pixel].x, scan[i].x);
    EXPECT_EQ(out.cloud.points[pixel].y, scan[i].y);
    EXPECT_EQ(out.cloud.points[pixel].intensity, 0.5F);
  }
  int empty = 0;
  for (const auto& point : out.cloud)
    if (std::isnan(point.x) && std::isnan(point.y) && std::isnan(point.z) && point.label == 0) ++empty;
  EXPECT_EQ(empty, 72 - 15);
  expectEveryPointInItsPixelsListOnce(out, 15);
}

TEST(PointProjection, TheNearestPointOwnsThePixel)
{
  const auto out = project({polar(91, 9), polar(92, 5), polar(93, 7), polar(94, 5), polar(181, 2)}, 1, 36);
  const auto pixel = out.pixel_of_point[0];
  for (int i = 1; i < 4; ++i) EXPECT_EQ(out.pixel_of_point[i], pixel);
  EXPECT_TRUE(out.owner_of_pixel[pixel] == 1 || out.owner_of_pixel[pixel] == 3);
  EXPECT_EQ(Ids(out.points.begin() + out.begin[pixel], out.points.begin() + out.begin[pixel + 1]), Ids({0, 1, 2, 3}));

  const auto equal = project({{3, 4, 0, 0}, {3, 4, 0, 0}}, 1, 36);
  EXPECT_EQ(equal.owner_of_pixel[equal.pixel_of_point[0]], 0U) << "the first of equals";
}

TEST(PointProjection, StraightBackIsColumnZero)
{
  const auto out = project({{-1, 0, 0, 0}, {-1, -0.0F, 0, 0}, {-1, -1e-9F, 0, 0}, {-1, -0.1F, 0, 0}}, 1, 16);
  EXPECT_EQ(out.pixel_of_point, Ids({0, 0, 0, 15}));
}

TEST(PointProjection, RingsTooManyGoIntoTheLastRow)
{
  std::vector<ScanPoint> scan;
  for (const float range : {10.0F, 9.0F, 8.0F, 7.0F, 6.0F})
    for (const double degrees : {45.0, 135.0, 225.0, 315.0}) scan.push_back(polar(degrees, range));
  const auto out = project(scan, 3, 16);
  EXPECT_EQ(out.rings, 5U);
  expectEveryPointInItsPixelsListOnce(out, scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i)
    EXPECT_EQ(out.pixel_of_point[i] / 16, std::min<std::size_t>(i / 4, 2)) << i;
  EXPECT_EQ(out.owner_of_pixel[out.pixel_of_point[8]], 16U) << "the nearest of the three last rings";
}

TEST(PointProjection, APointWithoutAReturnOwnsNothingAndIsNotLost)
{
  const std::vector<ScanPoint> scan{{kNan, 1, 1, 0},      polar(10, 5),  {0, 0, 0, 0},         {1, kInf, 0, 0},
                                    {3e38F, 3e38F, 0, 0}, polar(200, 5), {kNan, kNan, kNan, 0}};
  const auto out = project(scan, 2, 36);
  expectEveryPointInItsPixelsListOnce(out, scan.size());
  EXPECT_EQ(out.owner_of_pixel[out.pixel_of_point[0]], kNone);
  for (const int i : {2, 3, 4}) EXPECT_EQ(out.pixel_of_point[i], out.pixel_of_point[1]);
  EXPECT_EQ(out.owner_of_pixel[out.pixel_of_point[1]], 1U);
  EXPECT_EQ(out.pixel_of_point[6], out.pixel_of_point[5]);
}

TEST(PointProjection, ReusedBuffersGiveWhatFreshOnesDo)
{
  std::mt19937 random(7);
  PointProjector projector(config(8, 64));
  Projection reused;
  for (const std::size_t size : {900U, 0U, 1U, 400U})
  {
    const auto scan = randomScan(random, size);
    projector.project(scan, {}, reused);
    const auto fresh = project(scan, 8, 64);
    EXPECT_EQ(reused.pixel_of_point, fresh.pixel_of_point);
    EXPECT_EQ(reused.owner_of_pixel, fresh.owner_of_pixel);
    EXPECT_EQ(reused.begin, fresh.begin);
    EXPECT_EQ(reused.points, fresh.points);
    expectEveryPointInItsPixelsListOnce(reused, size);
    for (std::uint32_t pixel = 0; pixel < fresh.owner_of_pixel.size(); ++pixel)  // the nearest of those with a return
    {
      float least = kInf;
      for (auto i = fresh.begin[pixel]; i < fresh.begin[pixel + 1]; ++i)
      {
        const auto& p = scan[fresh.points[i]];
        const float squared = p.x * p.x + p.y * p.y + p.z * p.z;
        if (squared > 0.0F) least = std::min(least, squared);
      }
      const auto owner = fresh.owner_of_pixel[pixel];
      ASSERT_EQ(owner == kNone, std::isinf(least));
      if (owner == kNone) continue;
      const auto& p = scan[owner];
      ASSERT_EQ(p.x * p.x + p.y * p.y + p.z * p.z, least);
    }
  }
}

TEST(PointProjection, RefusesWhatDoesNotFit)
{
  Projection out;
  PointProjector projector{ProjectionConfig{}};
  const std::vector<ScanPoint> one = {polar(1, 1)};
  EXPECT_THROW(projector.project(one, {1, 2}, out), std::invalid_argument);
  EXPECT_THROW(PointProjector(config(0, 2048)), std::invalid_argument);
  EXPECT_THROW(PointProjector(config(64, 8)), std::invalid_argument);
}

TEST(PointProjection, FindsTheSensors64RingsInEveryRecordedScan)
{
  REQUIRE_RECORDED_DATA(data);
  PointProjector projector{ProjectionConfig{}};
  Projection out;
  std::vector<ScanPoint> scan;
  std::size_t scans = 0, points = 0, hidden = 0;
  for (const auto& name : semanticKittiSequences(data + "/semantickitti"))
  {
    const SemanticKittiSequence sequence(data + "/semantickitti", name);
    for (std::size_t i = 0; i < sequence.size(); ++i, ++scans)
    {
      sequence.readScan(i, scan);
      projector.project(scan, {}, out);
      EXPECT_EQ(out.rings, 64U) << name << "/" << sequence.scanName(i);
      expectEveryPointInItsPixelsListOnce(out, scan.size());
      for (std::size_t row = 0; row < 64; ++row)
      {
        const auto in_row = out.begin[(row + 1) * 2048] - out.begin[row * 2048];
        EXPECT_GE(in_row, 1071U) << name << "/" << sequence.scanName(i) << " row " << row;
        EXPECT_LE(in_row, 2173U) << name << "/" << sequence.scanName(i) << " row " << row;
      }
      points += scan.size();
      hidden += scan.size();
      for (const auto owner : out.owner_of_pixel) hidden -= owner != kNone;
    }
  }
  EXPECT_GE(scans, 1U);
  EXPECT_NEAR(static_cast<double>(hidden) / static_cast<double>(points), 0.086, 0.01);
}
}  // namespace lidar_panoptic_clustering
