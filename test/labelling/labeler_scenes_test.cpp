#include "labelled_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
RaySensor vlp16()
{
  RaySensor sensor;
  sensor.rows = 16, sensor.columns = 1800, sensor.top_deg = 15.0F, sensor.bottom_deg = -15.0F;
  return sensor;
}

TEST(LabelerScenes, ABusBesideTheSensorIsAnObject)
{
  const SceneBox bus{{-5.0F, 8.0F, 0.28F}, {7.0F, 10.5F, 3.1F}};
  for (const RaySensor& sensor : {RaySensor{}, vlp16()}) EXPECT_GT(Labelled(sceneOf({bus}), sensor).of(0).object, 0.9);
}

TEST(LabelerScenes, ARowOfParkedCarsIsNoWall)
{
  std::vector<SceneBox> boxes;
  for (int k = 0; k < 4; ++k)
  {
    const float x = -9.0F + 4.7F * static_cast<float>(k);
    boxes.push_back({{x, 5.0F, 0.22F}, {x + 4.2F, 6.8F, 1.5F}});
  }
  for (const RaySensor& sensor : {RaySensor{}, vlp16()})
  {
    const Labelled scan(sceneOf(boxes), sensor);
    for (int k = 0; k < 4; ++k) EXPECT_GT(scan.of(k).object, 0.9) << k;
  }
}

/// Beams that met the ground before the car came never near the gap under it.
TEST(LabelerScenes, BeamsThatNeverCameNearASillDoNotMakeAWall)
{
  const SceneBox car{{8.0F, -0.9F, 0.3F}, {12.2F, 0.9F, 1.5F}};
  RaySensor sensor = vlp16();
  for (float offset = 0.0F; offset < 2.0F; offset += 0.25F)
  {
    sensor.top_deg = 15.0F + offset, sensor.bottom_deg = -15.0F + offset;
    EXPECT_GT(Labelled(sceneOf({car}), sensor).of(0).object, 0.95) << offset;
  }
}

TEST(LabelerScenes, APersonAtACounterIsFoundAndTheStallIsStructure)
{
  // shelves to the ground, a metre and a half of them behind the person, closer than the link
  const SceneBox shelf{{9.0F, -3.0F, 0.0F}, {9.5F, 3.0F, 2.1F}};
  std::vector<SceneBox> boxes = personAt(8.45F, 0.0F);
  boxes.push_back(shelf);
  const Labelled scan(sceneOf(boxes));
  EXPECT_GT(scan.of(4).structure, 0.9);
  for (const int box : {0, 1, 2, 3}) EXPECT_GT(scan.of(box).object, 0.7) << box;
}

/// The foot of a wall below the height of a curb is the wall's, not ground.
TEST(LabelerScenes, TheFootOfAWallIsNoGround)
{
  const SceneBox wall{{9.0F, -12.0F, 0.0F}, {9.3F, 12.0F, 2.6F}};
  EXPECT_LT(Labelled(sceneOf({wall})).of(0).ground, 0.05);
}

/// Beams go through between its rails, and again above what it stands on; what they meet behind is ground.
TEST(LabelerScenes, TheLowWallUnderARailFenceIsTheFencesAndNoGround)
{
  std::vector<SceneBox> boxes = {{{6.0F, -6.0F, 0.0F}, {6.1F, 6.0F, 0.14F}}};
  for (const float low : {0.32F, 0.62F, 0.92F}) boxes.push_back({{6.02F, -6.0F, low}, {6.08F, 6.0F, low + 0.1F}});
  const Labelled scan(sceneOf(boxes));
  EXPECT_LT(scan.of(0).ground, 0.5);
  EXPECT_GT(scan.of(kGroundHit).ground, 0.999);
}

/// Beams go through under a car as under a rail.
TEST(LabelerScenes, TheGroundUnderASillStaysGround)
{
  for (const SceneBox& car : {kCarAhead, kCarBeside}) EXPECT_GT(Labelled(sceneOf({car})).of(kGroundHit).ground, 0.999);
}

/// Where beams lie closer to each other than ranges vary, noise alone bends any surface by more than their distance.
TEST(LabelerScenes, ANoisySensorsCarIsNoFoliage)
{
  const RayScene scene = sceneOf({kCarAhead, kCarBeside});
  RaySensor sensor;
  sensor.rows = 32, sensor.columns = 2048;
  std::vector<int> hits;
  LabelledCloud cloud = castScene(scene, sensor, hits);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0F, 0.03F);  // [m] a VLP-16's
  for (LabelledPoint& p : cloud)
  {
    const float range = p.getVector3fMap().norm();
    p.getVector3fMap() *= (range + noise(random)) / range;
  }
  GroundLabeler labeler{GroundLabelerConfig{}};
  labeler.label(cloud);
  for (const int car : {0, 1}) EXPECT_GT(sharesOf(cloud, hits, car).object, 0.8) << car;
}

TEST(LabelerScenes, TheBargainGoesTheWayItIsNamed)
{
  // a van of which only the upper half is seen, over a hedge
  const SceneBox hedge{{7.0F, -4.0F, 0.0F}, {7.4F, 4.0F, 1.2F}}, van{{8.6F, -0.5F, 0.3F}, {9.2F, 0.5F, 2.4F}};
  const auto kept = [&](const char* structure)
  {
    GroundLabelerConfig config;
    config.structure = structure;
    return Labelled(sceneOf({hedge, van}), {}, config).of(1).object;
  };
  EXPECT_LE(kept("strict"), kept("balanced"));
  EXPECT_LE(kept("balanced"), kept("keep_objects"));
  EXPECT_EQ(kept("strict"), 0.0);
  GroundLabelerConfig config;
  config.structure = "lenient";
  EXPECT_THROW(GroundLabeler{config}, std::invalid_argument);
}

TEST(LabelerScenes, TheGroundIsReported)
{
  RayScene scene = sceneOf({kCarBeside});
  scene.mount_height = 2.0F, scene.slope_x = 0.05F;
  const Labelled scan(scene);
  const GroundReport ground = scan.labeler.ground();
  ASSERT_TRUE(ground.found);
  EXPECT_NEAR(ground.sensor_height_m, 2.0 / std::hypot(1.0, 0.05), 0.03);
  EXPECT_NEAR(ground.slope_deg, 2.86, 0.2);
  LabelledCloud nothing = emptyCloud(4, 8);
  GroundLabeler labeler{GroundLabelerConfig{}};
  labeler.label(nothing);
  EXPECT_FALSE(labeler.ground().found);
}

/// A scan's returns as points without an order.
struct Unordered
{
  explicit Unordered(const RayScene& scene, const RaySensor& sensor = {})
  {
    std::vector<int> all;
    const LabelledCloud cloud = castScene(scene, sensor, all);
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i] != kMissed) order.push_back(i);
    std::mt19937 random(5);
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t i : order)
    {
      points.push_back({cloud.points[i].x, cloud.points[i].y, cloud.points[i].z, 0.0F});
      hits.push_back(all[i]);
    }
    GroundLabeler labeler{GroundLabelerConfig{}};
    labeler.labelUnordered(points, labels);
  }
  double share(int hit, std::uint32_t label) const
  {
    double count = 0.0, found = 0.0;
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (hits[i] == hit) count += 1.0, found += labels[i] == label ? 1.0 : 0.0;
    return found / count;
  }
  std::vector<ScanPoint> points;
  std::vector<int> hits;
  std::vector<std::uint32_t> labels;
};

TEST(LabelerScenes, PointsWithoutScanLinesAreLabelledToo)
{
  const SceneBox wall{{-30.0F, 12.0F, 0.0F}, {30.0F, 12.4F, 6.0F}};
  for (const RaySensor& sensor : {RaySensor{}, vlp16()})
  {
    const Unordered scan(sceneOf({kCarAhead, wall, kCarBeside}), sensor);
    ASSERT_EQ(scan.labels.size(), scan.points.size());
    EXPECT_GT(scan.share(kGroundHit, kGroundId), 0.98);
    EXPECT_GT(scan.share(0, kObjectId), 0.9);
    EXPECT_GT(scan.share(1, kStructureId), 0.85);
    EXPECT_GT(scan.share(2, kObjectId), 0.9);
  }
}

TEST(LabelerScenes, NoPointsNoLabels)
{
  GroundLabeler labeler{GroundLabelerConfig{}};
  std::vector<std::uint32_t> labels(3);
  labeler.labelUnordered({}, labels);
  EXPECT_TRUE(labels.empty());
  labeler.labelUnordered({{0.0F, 0.0F, 0.0F, 0.0F}}, labels);
  EXPECT_EQ(labels, std::vector<std::uint32_t>{kIgnoredId});
}
}  // namespace
}  // namespace lidar_panoptic_clustering
