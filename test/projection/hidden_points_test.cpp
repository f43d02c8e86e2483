#include "lidar_panoptic_clustering/projection/hidden_points.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "recorded_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace lidar_panoptic_clustering
{
namespace
{
using Ids = std::vector<std::uint32_t>;
constexpr auto kNone = Projection::kNone;

std::shared_ptr<const ClassTable> table()
{
  static const auto shared = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return shared;
}

ClassIndex classOf(std::uint32_t label)
{
  return table()->find(label & 0xFFFFU);
}

bool isThing(std::uint32_t label)
{
  return (*table())[classOf(label)].isThing();
}

struct Scene
{
  std::vector<ScanPoint> scan;
  Ids labels;
  Projection projection;
  Ids instance_of_pixel;
  Ids result;

  /// `pixel_instance(pixel, owner)`: what the clusterer gave an owned pixel of a thing.
  template <class PixelInstance>
  void run(int rows, int columns, PixelInstance&& pixel_instance)
  {
    ProjectionConfig config;
    config.rows = rows, config.columns = columns;
    PointProjector(config).project(scan, labels, projection);
    instance_of_pixel.assign(projection.cloud.size(), 0);
    for (std::uint32_t i = 0; i < instance_of_pixel.size(); ++i)
    {
      const auto owner = projection.owner_of_pixel[i];
      if (owner != kNone && isThing(labels[owner])) instance_of_pixel[i] = pixel_instance(i, owner);
    }
    HiddenPointLabeller(table()).label(scan, labels, projection, instance_of_pixel, result);
  }

  bool isHidden(std::uint32_t point) const
  {
    return projection.owner_of_pixel[projection.pixel_of_point[point]] != point;
  }

  int width() const { return static_cast<int>(projection.cloud.width); }
  int pixel(std::uint32_t point) const { return static_cast<int>(projection.pixel_of_point[point]); }
  int rowsApart(std::uint32_t a, std::uint32_t b) const { return std::abs(pixel(a) / width() - pixel(b) / width()); }
  int columnsApart(std::uint32_t a, std::uint32_t b) const
  {
    const int apart = std::abs(pixel(a) % width() - pixel(b) % width());
    return std::min(apart, width() - apart);
  }
  bool sameClass(std::uint32_t a, std::uint32_t b) const { return classOf(labels[a]) == classOf(labels[b]); }
};

ScanPoint polar(double degrees, float range)
{
  const double azimuth = degrees * M_PI / 180.0;
  return {range * static_cast<float>(std::cos(azimuth)), range * static_cast<float>(std::sin(azimuth)), 0.0F, 0.0F};
}

double distance(const ScanPoint& a, const ScanPoint& b)
{
  return std::hypot(static_cast<double>(a.x) - b.x, static_cast<double>(a.y) - b.y, static_cast<double>(a.z) - b.z);
}

/// Owners of the class within `rows` and `columns` of the point, nearest first.
std::multimap<double, std::uint32_t> ownersAround(const Scene& scene, std::uint32_t point, int rows, int columns)
{
  std::multimap<double, std::uint32_t> found;
  for (std::uint32_t other = 0; other < scene.scan.size(); ++other)
    if (!scene.isHidden(other) && scene.sameClass(point, other) && scene.rowsApart(point, other) <= rows &&
        scene.columnsApart(point, other) <= columns)
      found.emplace(distance(scene.scan[point], scene.scan[other]), other);
  return found;
}

/// Holds every point against the rule, by going over all pairs.
void expectRule(const Scene& scene)
{
  const auto& scan = scene.scan;
  Ids orphans;
  std::uint32_t largest = 0;
  for (const auto id : scene.instance_of_pixel) largest = std::max(largest, id);
  for (std::uint32_t i = 0; i < scan.size(); ++i)
  {
    if (!isThing(scene.labels[i]))
    {
      ASSERT_EQ(scene.result[i], 0U) << "stuff";
      continue;
    }
    if (!scene.isHidden(i))
    {
      ASSERT_EQ(scene.result[i], scene.instance_of_pixel[scene.projection.pixel_of_point[i]]);
      continue;
    }
    const double columns_a_metre = scene.projection.cloud.width / (2.0 * M_PI * std::hypot(scan[i].x, scan[i].y));
    const int columns = std::max(2, static_cast<int>(std::ceil(std::min(24.0, columns_a_metre))));
    auto owners = ownersAround(scene, i, 2, columns);
    if (owners.empty()) owners = ownersAround(scene, i, 4, 2 * columns);
    if (owners.empty())
    {
      orphans.push_back(i);
      continue;
    }
    const auto second = std::next(owners.begin());
    const bool clear_cut = second == owners.end() || second->first - owners.begin()->first > 1e-4;
    ASSERT_TRUE(!clear_cut || scene.result[i] == scene.result[owners.begin()->second]);
  }

  Ids component(orphans.size());
  for (std::uint32_t i = 0; i < component.size(); ++i) component[i] = i;
  for (bool changed = true; changed;)
  {
    changed = false;
    for (std::size_t a = 0; a < orphans.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (component[a] != component[b] && scene.sameClass(orphans[a], orphans[b]) &&
            scene.rowsApart(orphans[a], orphans[b]) <= 4 && scene.columnsApart(orphans[a], orphans[b]) <= 8)
          component[a] = component[b] = std::min(component[a], component[b]), changed = true;
  }
  std::map<std::uint32_t, std::uint32_t> id_of;
  for (std::size_t i = 0; i < orphans.size(); ++i)
  {
    const auto id = id_of.emplace(component[i], largest + static_cast<std::uint32_t>(id_of.size()) + 1).first->second;
    ASSERT_EQ(scene.result[orphans[i]], id);
  }
}
}  // namespace

TEST(HiddenPoints, TakeTheNearestOwnerOfTheirClass)
{
  Scene scene;
  // columns of 10 degrees: a car at 5 m hides one of the farther car's points, which owns the next pixel
  scene.scan = {polar(91, 5), polar(92, 9), polar(101, 9), polar(112, 5), polar(113, 6)};
  scene.labels = {10, 252, 10, 40, 40};
  scene.run(1, 36, [](std::uint32_t, std::uint32_t owner) { return owner == 0 ? 1U : 2U; });
  EXPECT_EQ(scene.result, Ids({1, 2, 2, 0, 0}));
}

TEST(HiddenPoints, AClassThatOwnsNoPixelNearFormsNewInstances)
{
  Scene scene;
  // two people behind a car, next to each other, and one behind the car on the other side
  scene.scan = {polar(51, 5), polar(52, 8), polar(61, 5), polar(62, 8), polar(63, 8), polar(252, 5), polar(253, 9)};
  scene.labels = {10, 30, 10, 30, 30, 10, 254};
  scene.run(1, 72, [](std::uint32_t, std::uint32_t owner) { return owner < 5 ? 1U : 2U; });
  EXPECT_EQ(scene.result, Ids({1, 3, 1, 3, 3, 2, 4}));
}

TEST(HiddenPoints, LooksOverTheWrap)
{
  Scene scene;
  scene.scan = {polar(178, 5), polar(179, 9), polar(181, 9)};
  scene.labels = {40, 10, 10};
  scene.run(1, 72, [](std::uint32_t, std::uint32_t) { return 1U; });
  EXPECT_EQ(scene.result, Ids({0, 1, 1}));
}

TEST(HiddenPoints, FollowOwnersThatWereDropped)
{
  Scene scene;
  scene.scan = {polar(91, 5), polar(92, 5.2F)};
  scene.labels = {10, 10};
  scene.run(1, 36, [](std::uint32_t, std::uint32_t) { return 0U; });
  EXPECT_EQ(scene.result, Ids({0, 0}));
}

TEST(HiddenPoints, FollowTheRuleOnRandomScenes)
{
  std::mt19937 random(11);
  const Ids classes{10, 252, 30, 11, 40, 70, 9999, 18};
  for (int round = 0; round < 60; ++round)
  {
    Scene scene;
    const int rows = 1 + round % 12, columns = round % 3 == 0 ? 16 : 64 + round;
    std::uniform_real_distribution<float> range(1.0F, round % 2 == 0 ? 8.0F : 60.0F);
    // few classes in long stretches leave some without an owner nearby
    std::uniform_int_distribution<std::size_t> class_at(0, classes.size() - 1);
    std::uniform_real_distribution<double> step(0.0, 1200.0 / columns);
    std::size_t label = 0;
    for (int row = 0; row < rows; ++row)
      for (double degrees = step(random); degrees < 360.0; degrees += step(random))
      {
        if (scene.scan.size() % 3 == 0) label = class_at(random);
        scene.scan.push_back(polar(degrees, range(random)));
        scene.labels.push_back(classes[label]);
      }
    scene.run(rows, columns, [](std::uint32_t pixel, std::uint32_t) { return 1 + pixel % 17; });
    expectRule(scene);
    if (HasFatalFailure()) FAIL() << "in round " << round;
  }
}

TEST(HiddenPoints, FollowTheRuleWhereOwnersAreFar)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> behind(1.0F, 3.0F);
  std::uniform_int_distribution<int> thousandth(0, 999);
  for (int round = 0; round < 20; ++round)
  {
    Scene scene;
    for (int row = 0; row < 12; ++row)  // a wall all around, few things before it and some behind
      for (double degrees = 0.6; degrees < 360.0; degrees += 1.2)
      {
        scene.scan.push_back(polar(degrees, 0.9F));
        scene.labels.push_back(thousandth(random) < 4 ? 10 : 50);
        if (thousandth(random) >= 8) continue;
        scene.scan.push_back(polar(degrees, behind(random)));
        scene.labels.push_back(thousandth(random) < 600 ? 10 : 30);
      }
    scene.run(12, 300, [](std::uint32_t pixel, std::uint32_t) { return 1 + pixel % 17; });
    expectRule(scene);
    if (HasFatalFailure()) FAIL() << "in round " << round;
  }
}

TEST(HiddenPoints, APointWithoutCoordinatesHasAnInstanceToo)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Scene scene;
  scene.scan = {polar(91, 5), {nan, nan, nan, 0}, {0, 0, 0, 0}, {1, INFINITY, 0, 0}};
  scene.labels = {10, 10, 10, 10};
  scene.run(1, 36, [](std::uint32_t, std::uint32_t) { return 1U; });
  EXPECT_EQ(scene.result, Ids({1, 2, 1, 2}));
}

TEST(HiddenPoints, PixelInstancesAreTheSameBeforeAndAfterPainting)
{
  ThingScan things;
  things.rows = 2, things.columns = 3;
  things.points = {{1, 0, 0, 1}, {2, 0, 0, 0}, {3, 0, 0, 2}};
  things.line_begin = {0, 1, 3};
  Instances instances;
  instances.id = {4, 5, 0};
  Ids of_scan, of_cloud;
  pixelInstances(things, instances, of_scan);
  EXPECT_EQ(of_scan, Ids({0, 4, 0, 5, 0, 0}));
  PanopticCloud cloud(3, 2);
  for (std::size_t i = 0; i < 6; ++i) cloud.points[i].instance = of_scan[i];
  pixelInstances(cloud, of_cloud);
  EXPECT_EQ(of_cloud, of_scan);
}

TEST(HiddenPoints, RefuseWhatDoesNotFit)
{
  Scene scene;
  scene.scan = {polar(91, 5)};
  scene.labels = {10};
  scene.run(1, 36, [](std::uint32_t, std::uint32_t) { return 1U; });
  HiddenPointLabeller labeller(table());
  EXPECT_THROW(labeller.label(scene.scan, {10, 10}, scene.projection, scene.instance_of_pixel, scene.result),
               std::invalid_argument);
  EXPECT_THROW(labeller.label(scene.scan, {10}, scene.projection, {}, scene.result), std::invalid_argument);
}

TEST(HiddenPoints, FindTheirTrueObjectOnRecordedScans)
{
  REQUIRE_RECORDED_DATA(data);
  std::size_t hidden = 0, right = 0;
  for (const auto& name : semanticKittiSequences(data + "/semantickitti"))
  {
    const SemanticKittiSequence sequence(data + "/semantickitti", name);
    for (std::size_t i = 0; i < sequence.size(); ++i)
    {
      Scene scene;
      sequence.readScan(i, scene.scan);
      sequence.readLabels(i, scene.scan.size(), scene.labels);
      const auto truth = [&](std::uint32_t point) { return rawInstance(scene.labels[point]) + 1; };
      scene.run(64, 2048, [&](std::uint32_t, std::uint32_t owner) { return truth(owner); });
      for (std::uint32_t point = 0; point < scene.scan.size(); ++point)
      {
        ASSERT_EQ(scene.result[point] > 0, isThing(scene.labels[point])) << name << "/" << sequence.scanName(i);
        if (!isThing(scene.labels[point]) || !scene.isHidden(point)) continue;
        ++hidden;
        right += scene.result[point] == truth(point);
      }
    }
  }
  EXPECT_GT(hidden, 10000U);
  EXPECT_GT(static_cast<double>(right), 0.998 * static_cast<double>(hidden));
}
}  // namespace lidar_panoptic_clustering
