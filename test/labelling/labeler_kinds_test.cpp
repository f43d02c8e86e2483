#include "labelled_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265F;

/// Four wheels at a body's corners.
void addWheels(const SceneBox& body, std::vector<SceneBox>& boxes)
{
  for (const float x : {body.low.x() + 0.4F, body.high.x() - 1.4F})
    for (const float y : {body.low.y(), body.high.y() - 0.3F})
      boxes.push_back({{x, y, 0.0F}, {x + 1.0F, y + 0.3F, 1.0F}});
}

RaySensor sparse()
{
  RaySensor sensor;
  sensor.rows = 16, sensor.columns = 1800, sensor.top_deg = 15.0F, sensor.bottom_deg = -15.0F;
  return sensor;
}

TEST(LabelerKinds, ALorryAndItsTrailerAreObjects)
{
  std::vector<SceneBox> boxes = {{{4.0F, 6.0F, 0.5F}, {10.0F, 8.5F, 3.6F}}, {{-4.0F, 6.0F, 0.6F}, {3.0F, 8.5F, 3.6F}}};
  const SceneBox lorry = boxes[0], trailer = boxes[1];
  addWheels(lorry, boxes), addWheels(trailer, boxes);
  for (const RaySensor& sensor : {RaySensor{}, sparse()})
  {
    const Labelled scan(sceneOf(boxes), sensor);
    EXPECT_GT(scan.of(0).object, 0.9);
    EXPECT_GT(scan.of(1).object, 0.9);
  }
}

/// A van's whole side, seen square on: its width does not show.
TEST(LabelerKinds, ABareFlankOverItsWheelsIsAnObject)
{
  std::vector<SceneBox> boxes = {{{-2.5F, 6.0F, 0.3F}, {2.5F, 8.0F, 2.5F}}};
  addWheels(SceneBox(boxes[0]), boxes);
  for (const RaySensor& sensor : {RaySensor{}, sparse()}) EXPECT_GT(Labelled(sceneOf(boxes), sensor).of(0).object, 0.9);
}

TEST(LabelerKinds, TwoPeopleSideBySideAreObjects)
{
  std::vector<SceneBox> boxes = personAt(9.0F, 0.0F);
  for (const SceneBox& box : personAt(9.0F, 0.9F)) boxes.push_back(box);
  const Labelled scan(sceneOf(boxes));
  for (const int torso : {2, 6}) EXPECT_GT(scan.of(torso).object, 0.9);
}

TEST(LabelerKinds, APersonAMeterBeforeAWallIsAnObjectAndTheWallIsNot)
{
  std::vector<SceneBox> boxes = personAt(9.0F, 0.0F);
  boxes.push_back({{10.0F, -15.0F, 0.0F}, {10.3F, 15.0F, 4.0F}});
  const Labelled scan(sceneOf(boxes));
  EXPECT_GT(scan.of(2).object, 0.9);
  EXPECT_GT(scan.of(4).structure, 0.9);
}

/// On a bicycle seen from the side: the rider, found first, makes no stall of it.
TEST(LabelerKinds, ABicycleUnderItsRiderIsAnObject)
{
  std::vector<SceneBox> boxes = {{{8.95F, -0.85F, 0.15F}, {9.05F, -0.2F, 0.65F}},
                                 {{8.95F, 0.2F, 0.15F}, {9.05F, 0.85F, 0.65F}},
                                 {{8.95F, -0.5F, 0.55F}, {9.05F, 0.6F, 0.85F}},
                                 {{8.95F, -0.6F, 0.0F}, {9.05F, -0.45F, 0.15F}},
                                 {{8.95F, 0.45F, 0.0F}, {9.05F, 0.6F, 0.15F}}};
  for (SceneBox box : personAt(9.0F, -0.1F))
  {
    box.low.z() = std::max(box.low.z(), 0.2F);  // feet are on pedals
    boxes.push_back(box);
  }
  for (const RaySensor& sensor : {RaySensor{}, sparse()})
  {
    const Labelled scan(sceneOf(boxes), sensor);
    for (const int part : {0, 1, 2, 7}) EXPECT_GT(scan.of(part).object, 0.8) << part;
  }
}

/// Down to the ground, and the ground before it is none of it.
TEST(LabelerKinds, ALowWallIsStructureDownToItsFoot)
{
  for (const float distance : {5.0F, 8.0F, 12.0F})
  {
    const Labelled scan(sceneOf({{{distance, -8.0F, 0.0F}, {distance + 0.3F, 8.0F, 0.6F}}}));
    EXPECT_LT(scan.of(0).ground, 0.01) << distance;
    EXPECT_GT(scan.of(kGroundHit).ground, 0.995) << distance;
  }
}

/// Frame and wheels, which touch the ground in a narrow place, a metre before the fence.
TEST(LabelerKinds, ABicycleBeforeAFenceIsAnObject)
{
  const std::vector<SceneBox> boxes = {
      {{7.0F, 4.95F, 0.3F}, {8.0F, 5.05F, 1.0F}},   {{6.7F, 4.96F, 0.15F}, {7.3F, 5.04F, 0.65F}},
      {{7.8F, 4.96F, 0.15F}, {8.4F, 5.04F, 0.65F}}, {{-20.0F, 6.0F, 0.0F}, {30.0F, 6.1F, 1.8F}},
      {{6.9F, 4.96F, 0.0F}, {7.1F, 5.04F, 0.15F}},  {{8.0F, 4.96F, 0.0F}, {8.2F, 5.04F, 0.15F}}};
  const Labelled scan(sceneOf(boxes));
  EXPECT_GT(scan.of(0).object, 0.8);
  EXPECT_GT(scan.of(3).structure, 0.9);
}

/// A house that goes on on either side of what hides its foot.
TEST(LabelerKinds, AHouseOverParkedCarsIsStructure)
{
  std::vector<SceneBox> boxes = {{{-25.0F, 10.0F, 0.0F}, {25.0F, 10.6F, 3.9F}}};
  for (int k = 0; k < 9; ++k)
  {
    const float x = -20.0F + 4.6F * static_cast<float>(k);
    boxes.push_back({{x, 5.5F, 0.22F}, {x + 4.2F, 7.3F, 1.5F}});
  }
  EXPECT_GT(Labelled(sceneOf(boxes)).of(0).structure, 0.9);
}

/// On a street without anything as high as the sensor, no beam that hits something is its highest.
TEST(LabelerKinds, ABoxOnAnEmptyPlaneIsAnObjectHoweverFewRowsReturn)
{
  const SceneBox box{{8.0F, 2.0F, 0.0F}, {12.0F, 4.0F, 1.5F}};
  RaySensor sensor;
  sensor.rows = 50, sensor.top_deg = -1.25F;  // what is left of 64 rows where the upper ones return nothing
  EXPECT_GT(Labelled(sceneOf({box}), sensor).of(0).object, 0.95);
  sensor.top_deg = 3.0F;
  EXPECT_GT(Labelled(sceneOf({box}), sensor).of(0).object, 0.95);
}

/// Rays to a ground of any shape, with a box that stands on it.
Shares castOver(const std::function<float(float, float)>& ground, const SceneBox* box, int wanted)
{
  RaySensor sensor;
  LabelledCloud cloud = emptyCloud(sensor.rows, sensor.columns);
  std::vector<int> hits(cloud.size(), kMissed);
  const Eigen::Vector3f origin(0.0F, 0.0F, 1.73F);
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
  {
    const float row = static_cast<float>(i / sensor.columns), column = static_cast<float>(i % sensor.columns);
    const Eigen::Vector3f direction =
        directionOf(kPi / 180.0F * (3.0F - 28.0F * row / 63.0F), kPi * (1.0F - 2.0F * (column + 0.37F) / 1024.0F));
    float range = box == nullptr ? 80.0F : std::min(80.0F, distanceTo(*box, origin, direction));
    int hit = range < 80.0F ? 0 : kMissed;
    for (float r = 1.0F; r < range; r += 0.05F)
    {
      const Eigen::Vector3f at = origin + r * direction;
      if (at.z() > ground(at.x(), at.y())) continue;
      range = r, hit = kGroundHit;
      break;
    }
    if (hit == kMissed) continue;
    cloud.points[i].getVector3fMap() = range * direction;
    hits[i] = hit;
  }
  GroundLabeler labeler{GroundLabelerConfig{}};
  labeler.label(cloud);
  return sharesOf(cloud, hits, wanted);
}

TEST(LabelerKinds, ACrestAndADipAreGround)
{
  // level for 15 m, then 6 % down, or up
  for (const float slope : {-0.06F, 0.06F})
  {
    const auto ground = [slope](float x, float) { return slope * std::max(0.0F, x - 15.0F); };
    EXPECT_GT(castOver(ground, nullptr, kGroundHit).ground, 0.97) << slope;
    const float foot = ground(22.0F, 0.0F);
    const SceneBox car{{20.0F, -0.9F, foot + 0.35F}, {24.0F, 0.9F, foot + 1.6F}};
    EXPECT_GT(castOver(ground, &car, 0).object, 0.9) << slope;
  }
}

TEST(LabelerKinds, GrassIsGround)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<float> blade(0.0F, 0.1F);
  const auto ground = [&](float, float) { return blade(random); };
  EXPECT_GT(castOver(ground, nullptr, kGroundHit).ground, 0.97);
}

TEST(LabelerKinds, ASensorOnItsHeadHasNoGroundAndNothingIsGround)
{
  RayScene scene = sceneOf({kCarAhead, {{-30.0F, 12.0F, 0.0F}, {30.0F, 12.4F, 6.0F}}});
  scene.tilt = Eigen::AngleAxisf(kPi, Eigen::Vector3f::UnitX());
  const Labelled scan(scene);
  EXPECT_FALSE(scan.labeler.ground().found);
  EXPECT_TRUE(std::isnan(scan.labeler.heightOf(3.0F, 0.0F, 0.0F)));
  EXPECT_EQ(scan.of(kGroundHit).ground, 0.0);
}

/// Points in the order of their firing, without rows.
struct Firings
{
  void fire(const RayScene& scene, float azimuth, float elevation, float ahead = 0.0F)
  {
    const Eigen::Vector3f direction = directionOf(elevation, azimuth);
    int hit = kMissed;
    const float range = nearestHit(scene, direction, hit);
    if (!(range < 80.0F)) return;
    points.push_back({range * direction.x() + ahead, range * direction.y(), range * direction.z(), 0.0F});
    hits.push_back(hit);
  }
  void label() { labeler.labelUnordered(points, labels); }
  double share(int hit, std::uint32_t wanted) const
  {
    double count = 0.0, found = 0.0;
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (hits[i] == hit) count += 1.0, found += labels[i] == wanted ? 1.0 : 0.0;
    return found / count;
  }
  GroundLabeler labeler{GroundLabelerConfig{}};
  std::vector<ScanPoint> points;
  std::vector<int> hits;
  std::vector<std::uint32_t> labels;
};

/// Petals that never close, as two turning prisms draw them: dense in the middle, no row, no column.
TEST(LabelerKinds, ARosetteWithoutRowsIsLabelled)
{
  const RayScene scene = sceneOf({kCarAhead, {{25.0F, -20.0F, 0.0F}, {25.5F, 20.0F, 6.0F}}});
  Firings scan;
  for (int i = 0; i < 60000; ++i)
  {
    const float t = 0.013F * static_cast<float>(i), radius = 35.0F * kPi / 180.0F * std::sin(2.3716F * t);
    scan.fire(scene, radius * std::cos(t), radius * std::sin(t));
  }
  scan.label();
  EXPECT_GT(scan.share(0, kObjectId), 0.9);
  EXPECT_GT(scan.share(1, kStructureId), 0.9);
  EXPECT_GT(scan.share(kGroundHit, kGroundId), 0.95);
}

TEST(LabelerKinds, TwoLidarsInOneCloudAreLabelled)
{
  const SceneBox wall{{-30.0F, 12.0F, 0.0F}, {30.0F, 12.4F, 6.0F}};
  const RayScene scene = sceneOf({kCarAhead, wall, kCarBeside});
  Firings scan;
  for (const float ahead : {0.0F, 1.5F})
  {
    RayScene seen = scene;  // from a lidar that stands farther ahead
    for (SceneBox& box : seen.boxes) box.low.x() -= ahead, box.high.x() -= ahead;
    for (int row = 0; row < 32; ++row)
      for (int column = 0; column < 1024; ++column)
        scan.fire(seen, kPi * (1.0F - static_cast<float>(column) / 512.0F),
                  kPi / 180.0F * (5.0F - 0.95F * static_cast<float>(row)), ahead);
  }
  scan.label();
  EXPECT_GT(scan.share(0, kObjectId), 0.85);
  EXPECT_GT(scan.share(1, kStructureId), 0.85);
  EXPECT_GT(scan.share(2, kObjectId), 0.85);
  EXPECT_GT(scan.share(kGroundHit, kGroundId), 0.97);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
