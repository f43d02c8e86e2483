#include "lidar_panoptic_clustering/refinement/instance_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
using Points = std::vector<std::pair<float, float>>;

struct Fixture
{
  ThingScan scan;
  Instances instances;

  void add(float x, float y, float z, std::uint32_t id)
  {
    scan.points.push_back({x, y, z, 0});
    instances.id.push_back(id);
    if (id == 0) return;
    if (instances.objects.size() < id) instances.objects.resize(id);
    ++instances.objects[id - 1].point_count;
  }
};

InstanceBox fit(const Points& points)
{
  Fixture fixture;
  for (const auto& [x, y] : points) fixture.add(x, y, 0.0F, 1);
  InstanceBoxes boxes;
  return boxes.fit(fixture.scan, fixture.instances).at(0);
}

/// The two sides of the rectangle along direction (ux, uy), of length 1, around the points.
std::pair<double, double> sidesAlong(const Points& points, double ux, double uy)
{
  double min_u = std::numeric_limits<double>::infinity(), max_u = -min_u, min_v = min_u, max_v = -min_u;
  for (const auto& [x, y] : points)
  {
    const double u = ux * x + uy * y, v = ux * y - uy * x;
    min_u = std::min(min_u, u), max_u = std::max(max_u, u);
    min_v = std::min(min_v, v), max_v = std::max(max_v, v);
  }
  return {max_u - min_u, max_v - min_v};
}

/// The least area over the directions of all pairs of points, which the hull's sides are among; cubic.
double leastArea(const Points& points)
{
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [ax, ay] : points)
    for (const auto& [bx, by] : points)
    {
      const double dx = static_cast<double>(bx) - ax, dy = static_cast<double>(by) - ay, length = std::hypot(dx, dy);
      if (length == 0.0) continue;
      const auto [a, b] = sidesAlong(points, dx / length, dy / length);
      least = std::min(least, a * b);
    }
  return std::isinf(least) ? 0.0 : least;
}

/// The least area over 3600 directions: never below the true one.
double sampledLeastArea(const Points& points)
{
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3600; ++i)
  {
    const auto [a, b] = sidesAlong(points, std::cos(kPi / 7200.0 * i), std::sin(kPi / 7200.0 * i));
    least = std::min(least, a * b);
  }
  return least;
}

/// The box is the tight one in its own direction, and its members keep what they promise.
void expectTight(const InstanceBox& box, const Points& points, double tolerance)
{
  EXPECT_GE(box.length, box.width);
  EXPECT_GE(box.width, 0.0F);
  EXPECT_GT(box.yaw, -kPi / 2.0 - 1e-6);
  EXPECT_LE(box.yaw, kPi / 2.0 + 1e-6);
  const double ux = std::cos(box.yaw), uy = std::sin(box.yaw);
  const auto [length, width] = sidesAlong(points, ux, uy);
  EXPECT_NEAR(box.length, length, tolerance);
  EXPECT_NEAR(box.width, width, tolerance);
  for (const auto& [x, y] : points)
  {
    EXPECT_LE(std::abs(ux * (x - box.x) + uy * (y - box.y)), 0.5 * length + tolerance);
    EXPECT_LE(std::abs(ux * (y - box.y) - uy * (x - box.x)), 0.5 * width + tolerance);
  }
}

void expectLeast(const Points& points)
{
  const InstanceBox box = fit(points);
  expectTight(box, points, 1e-4);
  const double area = leastArea(points);
  EXPECT_NEAR(static_cast<double>(box.length) * box.width, area, 1e-4 * (1.0 + area));
}

TEST(InstanceBoxes, OnePointIsABoxWithoutSize)
{
  const InstanceBox box = fit({{3.0F, -4.0F}});
  EXPECT_EQ(box.x, 3.0F);
  EXPECT_EQ(box.y, -4.0F);
  EXPECT_EQ(box.length, 0.0F);
  EXPECT_EQ(box.width, 0.0F);
  EXPECT_EQ(box.height, 0.0F);
  EXPECT_EQ(box.yaw, 0.0F);
}

TEST(InstanceBoxes, TwoPointsAndDuplicatesAreALine)
{
  for (const int copies : {1, 5})
  {
    Points points;
    for (int i = 0; i < copies; ++i) points.push_back({1.0F, 1.0F}), points.push_back({4.0F, 5.0F});
    const InstanceBox box = fit(points);
    EXPECT_FLOAT_EQ(box.x, 2.5F);
    EXPECT_FLOAT_EQ(box.y, 3.0F);
    EXPECT_FLOAT_EQ(box.length, 5.0F);
    EXPECT_FLOAT_EQ(box.width, 0.0F);
    EXPECT_FLOAT_EQ(box.yaw, std::atan2(4.0F, 3.0F));
  }
}

TEST(InstanceBoxes, CollinearPointsInEveryDirection)
{
  for (const auto& [dx, dy] : Points{{1, 0}, {0, 1}, {1, 1}, {-1, 2}, {1, -1}})
  {
    Points points;
    for (const float t : {3.0F, 0.0F, 1.0F, 4.0F, 2.0F, 4.0F}) points.push_back({7.0F + t * dx, t * dy});
    const InstanceBox box = fit(points);
    EXPECT_NEAR(box.length, 4.0F * std::hypot(dx, dy), 1e-5);
    EXPECT_NEAR(box.width, 0.0F, 1e-5);
    EXPECT_NEAR(box.x, 7.0F + 2.0F * dx, 1e-5);
    EXPECT_NEAR(box.y, 2.0F * dy, 1e-5);
    EXPECT_NEAR(std::abs(std::cos(box.yaw) * dy - std::sin(box.yaw) * dx), 0.0F, 1e-5);
    EXPECT_GT(box.yaw, -kPi / 2.0);
    EXPECT_LE(box.yaw, kPi / 2.0 + 1e-6);
  }
}

TEST(InstanceBoxes, RectanglesInEveryDirection)
{
  for (int degrees = -360; degrees <= 360; degrees += 5)
  {
    SCOPED_TRACE(degrees);
    const float yaw = static_cast<float>(degrees * kPi / 180.0), c = std::cos(yaw), s = std::sin(yaw);
    Points points;
    for (int i = 0; i <= 20; ++i)
      for (const float side : {-0.9F, 0.9F})
      {
        const float u = 0.2F * static_cast<float>(i) - 2.0F;
        points.push_back({12.0F + c * u - s * side, -30.0F + s * u + c * side});
      }
    const InstanceBox box = fit(points);
    EXPECT_NEAR(box.x, 12.0F, 1e-4);
    EXPECT_NEAR(box.y, -30.0F, 1e-4);
    EXPECT_NEAR(box.length, 4.0F, 1e-4);
    EXPECT_NEAR(box.width, 1.8F, 1e-4);
    EXPECT_NEAR(std::sin(box.yaw - yaw), 0.0, 1e-4);  // the same axis, whichever way
    EXPECT_GT(box.yaw, -kPi / 2.0 - 1e-6);
    EXPECT_LE(box.yaw, kPi / 2.0 + 1e-6);
  }
}

TEST(InstanceBoxes, RandomPointsAgreeWithAllDirections)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  for (int round = 0; round < 400; ++round)
  {
    SCOPED_TRACE(round);
    Points points;
    const float x = 80.0F * unit(random), y = 80.0F * unit(random);
    const std::size_t count = 1 + random() % 40;
    for (std::size_t i = 0; i < count; ++i) points.push_back({x + 5.0F * unit(random), y + 2.0F * unit(random)});
    expectLeast(points);
  }
}

/// Small whole numbers: many points on one side, many sides of the same direction.
TEST(InstanceBoxes, PointsOfAGridAgreeWithAllDirections)
{
  std::mt19937 random(2);
  for (int round = 0; round < 400; ++round)
  {
    SCOPED_TRACE(round);
    Points points;
    const std::size_t size = 1 + random() % 6;
    const std::size_t count = 1 + random() % 30;
    for (std::size_t i = 0; i < count; ++i)
      points.push_back({static_cast<float>(random() % size), static_cast<float>(random() % size)});
    expectLeast(points);
  }
}

TEST(InstanceBoxes, ManyPointsOnAndInACircle)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Points circle, disc;
  for (int i = 0; i < 1000; ++i)
  {
    const double angle = 2.0 * kPi * i / 1000.0;
    circle.push_back({static_cast<float>(50.0 + 3.0 * std::cos(angle)), static_cast<float>(3.0 * std::sin(angle))});
  }
  while (disc.size() < 20000)
    if (const float x = unit(random), y = unit(random); x * x + y * y < 1.0F) disc.push_back({2.0F * x, y - 70.0F});
  for (const auto& points : {circle, disc})
  {
    const InstanceBox box = fit(points);
    expectTight(box, points, 1e-4);
    EXPECT_LE(static_cast<double>(box.length) * box.width, sampledLeastArea(points) + 1e-3);
  }
  EXPECT_NEAR(fit(circle).length, 6.0F, 1e-3);
}

TEST(InstanceBoxes, EachInstanceHasItsOwnBoxFromLowestToHighest)
{
  Fixture fixture;
  InstanceBoxes boxes;
  EXPECT_TRUE(boxes.fit(fixture.scan, fixture.instances).empty());

  fixture.add(1.0F, 0.0F, -1.5F, 2);
  fixture.add(500.0F, 500.0F, 99.0F, 0);  // of no instance
  fixture.add(10.0F, 0.0F, 2.0F, 1);
  fixture.add(3.0F, 0.0F, 0.5F, 2);
  fixture.add(2.0F, 0.0F, -0.5F, 2);
  const auto& found = boxes.fit(fixture.scan, fixture.instances);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].x, 10.0F);
  EXPECT_EQ(found[0].z, 2.0F);
  EXPECT_EQ(found[0].height, 0.0F);
  EXPECT_EQ(found[1].x, 2.0F);
  EXPECT_EQ(found[1].length, 2.0F);
  EXPECT_EQ(found[1].z, -0.5F);
  EXPECT_EQ(found[1].height, 2.0F);

  EXPECT_TRUE(boxes.fit(ThingScan(), Instances()).empty()) << "boxes of the scan before are gone";
}
}  // namespace
}  // namespace lidar_panoptic_clustering
