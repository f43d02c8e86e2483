#include "lidar_panoptic_clustering/labelling/ground_labeler.h"

#include "labelled_scene.h"
#include "lidar_panoptic_clustering/core/class_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
std::string messageOf(const std::function<void()>& call)
{
  try
  {
    call();
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(GroundLabeler, IdsAreThoseOfTheTable)
{
  const ClassTable table = ClassTable::load("object");
  EXPECT_EQ(table[table.find(kIgnoredId)].name, "ignored");
  EXPECT_EQ(table[table.find(kGroundId)].name, "ground");
  EXPECT_EQ(table[table.find(kStructureId)].name, "structure");
  EXPECT_EQ(table[table.find(kObjectId)].name, "object");
  EXPECT_TRUE(table[table.find(kObjectId)].isThing());
}

/// Mount height, slope of the ground x and y, tilt of the sensor about x and y [degrees].
struct Mounting
{
  float height, slope_x, slope_y, roll_deg, pitch_deg;
};

class Mountings : public testing::TestWithParam<Mounting>
{
};

TEST_P(Mountings, TheGroundIsFoundAndACarStandsOnIt)
{
  const Mounting& m = GetParam();
  constexpr float kDegree = 3.14159265F / 180.0F;
  RayScene scene = sceneOf({kCarAhead});
  const float rise = m.slope_x * scene.boxes[0].low.x();  // the box keeps level; its foot stays clear of the ground
  scene.boxes[0].low.z() += rise + 4.2F * std::max(0.0F, m.slope_x), scene.boxes[0].high.z() += rise;
  scene.mount_height = m.height, scene.slope_x = m.slope_x, scene.slope_y = m.slope_y;
  scene.tilt = Eigen::AngleAxisf(m.roll_deg * kDegree, Eigen::Vector3f::UnitX()) *
               Eigen::AngleAxisf(m.pitch_deg * kDegree, Eigen::Vector3f::UnitY());
  const Labelled scan(scene);
  ASSERT_TRUE(scan.labeler.foundGround());
  EXPECT_NEAR(scan.labeler.groundPlane().offset, -m.height, 0.1 * m.height);
  EXPECT_GT(scan.of(kGroundHit).ground, 0.995);
  EXPECT_GT(scan.of(0).count, 100);
  EXPECT_GT(scan.of(0).object, 0.9);
}

INSTANTIATE_TEST_SUITE_P(Labeler, Mountings,
                         testing::Values(Mounting{1.73F, 0, 0, 0, 0}, Mounting{0.6F, 0, 0, 0, 0},
                                         Mounting{3.5F, 0, 0, 0, 0}, Mounting{1.73F, 0.1F, 0, 0, 0},
                                         Mounting{1.73F, -0.1F, 0.05F, 0, 0}, Mounting{1.73F, 0, 0, 5, 0},
                                         Mounting{1.73F, 0, 0, 0, 6}, Mounting{2.2F, 0.04F, -0.04F, -4, -5}));

TEST(GroundLabeler, VehiclesOnWheelsAreObjectsWhateverTheirSize)
{
  const SceneBox bus{{-4.0F, -6.0F, 0.3F}, {8.0F, -3.5F, 3.1F}};
  const SceneBox lorry{{12.0F, 8.0F, 0.5F}, {28.0F, 10.5F, 3.9F}};
  const Labelled scan(sceneOf({kCarAhead, kCarBeside, bus, lorry}));
  for (const int box : {0, 1, 2, 3})
  {
    EXPECT_GT(scan.of(box).count, 200) << box;
    EXPECT_GT(scan.of(box).object, 0.95) << box;
  }
}

TEST(GroundLabeler, WallsAreStructureShortOnesToo)
{
  const SceneBox street_long{{-40.0F, 8.0F, 0.0F}, {40.0F, 8.4F, 6.0F}};
  const SceneBox garage{{9.0F, -4.0F, 0.0F}, {9.3F, 3.0F, 2.6F}};
  const SceneBox garden{{-9.0F, -6.0F, 0.0F}, {-2.0F, -5.8F, 1.1F}};
  const Labelled scan(sceneOf({street_long, garage, garden}));
  for (const int box : {0, 1, 2})
  {
    EXPECT_GT(scan.of(box).count, 500) << box;
    EXPECT_EQ(scan.of(box).object, 0.0) << box;
    EXPECT_GT(scan.of(box).structure, 0.8) << box;
  }
}

TEST(GroundLabeler, PolesAreStructureAndPeopleAreNot)
{
  const SceneBox lamp{{7.0F, 2.0F, 0.0F}, {7.15F, 2.15F, 6.0F}};
  const SceneBox post{{5.0F, -2.0F, 0.0F}, {5.1F, -1.9F, 1.8F}};
  std::vector<SceneBox> boxes = {lamp, post};
  for (const auto& [x, y] : {std::pair{7.0F, -3.0F}, std::pair{-6.0F, 4.0F}, std::pair{14.0F, 5.0F}})
    for (const SceneBox& box : personAt(x, y)) boxes.push_back(box);
  const Labelled scan(sceneOf(boxes));
  EXPECT_GT(scan.of(0).structure, 0.9);
  EXPECT_GT(scan.of(1).structure, 0.85);
  for (int box = 2; box < 14; ++box)
  {
    EXPECT_GT(scan.of(box).count, 5) << box;
    EXPECT_EQ(scan.of(box).structure, 0.0) << box;
    EXPECT_GT(scan.of(box).object, 0.7) << box;
  }
}

TEST(GroundLabeler, APersonBesideAWallStaysAnObject)
{
  const SceneBox wall{{-30.0F, 9.0F, 0.0F}, {30.0F, 9.4F, 6.0F}};
  std::vector<SceneBox> boxes = personAt(0.0F, 7.7F);
  boxes.push_back(wall);
  const Labelled scan(sceneOf(boxes));
  EXPECT_GT(scan.of(4).structure, 0.9);
  EXPECT_EQ(scan.of(0).count, 0) << "the far leg is hidden";
  for (const int box : {1, 2, 3}) EXPECT_GT(scan.of(box).object, 0.7) << box;
}

TEST(GroundLabeler, ABridgeOverACarIsStructureAndTheCarIsNot)
{
  const SceneBox bridge{{6.0F, -12.0F, 4.6F}, {14.0F, 12.0F, 5.4F}};
  RaySensor sensor;
  sensor.top_deg = 25.0F;
  const Labelled scan(sceneOf({kCarAhead, bridge}), sensor);
  EXPECT_GT(scan.of(0).object, 0.95);
  EXPECT_GT(scan.of(1).count, 500);
  EXPECT_EQ(scan.of(1).structure, 1.0);
  EXPECT_GT(scan.of(kGroundHit).ground, 0.995);
}

TEST(GroundLabeler, BranchesOverACarAreStructure)
{
  const SceneBox branches{{7.5F, -1.5F, 2.6F}, {10.0F, 1.5F, 3.4F}};
  RaySensor sensor;
  sensor.top_deg = 25.0F;
  const Labelled scan(sceneOf({kCarAhead, branches}), sensor);
  EXPECT_GT(scan.of(0).object, 0.95);
  EXPECT_GT(scan.of(1).structure, 0.95);
}

TEST(GroundLabeler, CurbsAndRampsAreGround)
{
  const SceneBox sidewalk{{-60.0F, 4.0F, -1.0F}, {60.0F, 60.0F, 0.12F}};
  const Labelled curb(sceneOf({sidewalk}));
  EXPECT_GT(curb.of(kGroundHit).ground, 0.995);
  EXPECT_GT(curb.of(0).ground, 0.995);

  // a ramp of 5 % that begins 8 m ahead, in steps of 5 cm
  std::vector<SceneBox> steps;
  for (int k = 1; k <= 20; ++k)
    steps.push_back({{8.0F + static_cast<float>(k), -30.0F, -1.0F}, {60.0F, 30.0F, 0.05F * static_cast<float>(k)}});
  const Labelled ramp(sceneOf(steps));
  for (int k = 0; k < 20; ++k) EXPECT_GT(ramp.of(k).ground, 0.98) << "step " << k;
}

TEST(GroundLabeler, SixteenBeamsAreEnough)
{
  RaySensor vlp16;
  vlp16.rows = 16, vlp16.columns = 1800, vlp16.top_deg = 15.0F, vlp16.bottom_deg = -15.0F;
  const SceneBox wall{{-40.0F, 12.0F, 0.0F}, {40.0F, 12.4F, 8.0F}};
  const Labelled scan(sceneOf({kCarAhead, wall}), vlp16);
  EXPECT_GT(scan.of(kGroundHit).ground, 0.995);
  EXPECT_GT(scan.of(0).object, 0.95);
  EXPECT_GT(scan.of(1).structure, 0.9);
}

TEST(GroundLabeler, TheOwnVehicleDoesNotHideTheGround)
{
  const SceneBox roof{{-1.5F, -0.8F, 1.2F}, {2.0F, 0.8F, 1.35F}};
  const Labelled scan(sceneOf({roof, kCarAhead}));
  EXPECT_NEAR(scan.labeler.groundPlane().offset, -1.73, 0.05);
  EXPECT_EQ(scan.of(0).ground, 0.0);
  EXPECT_GT(scan.of(kGroundHit).ground, 0.995);
}

TEST(GroundLabeler, ASectorIsEnoughAndDoesNotClose)
{
  RaySensor sector;
  sector.columns = 400, sector.from_deg = 60.0F, sector.turn_deg = 120.0F;
  const Labelled scan(sceneOf({kCarAhead}), sector);
  EXPECT_GT(scan.of(kGroundHit).ground, 0.995);
  EXPECT_GT(scan.of(0).object, 0.95);
}

TEST(GroundLabeler, CarsAtBothEndsOfASectorAreTwo)
{
  RaySensor sector;
  sector.columns = 256, sector.from_deg = 45.0F, sector.turn_deg = 90.0F;
  const SceneBox left{{6.0F, 6.1F, 0.22F}, {10.4F, 7.9F, 1.5F}}, right{{6.0F, -7.9F, 0.22F}, {10.4F, -6.1F, 1.5F}};
  for (const char* field_of_view : {"auto", "sector", "full_turn"})
  {
    GroundLabelerConfig config;
    config.field_of_view = field_of_view;
    const Labelled scan(sceneOf({left, right}), sector, config);
    for (const int box : {0, 1})
    {
      EXPECT_GT(scan.of(box).count, 100) << field_of_view;
      if (config.field_of_view == "full_turn")
        EXPECT_LT(scan.of(box).object, 0.1) << "one thing too wide for a vehicle";
      else
        EXPECT_GT(scan.of(box).object, 0.95) << field_of_view;
    }
  }
}

TEST(GroundLabeler, NothingButTheLabelsChanges)
{
  RayScene scene = sceneOf({kCarAhead, kCarBeside});
  std::vector<int> hits;
  LabelledCloud cloud = castScene(scene, {}, hits);
  cloud.header.frame_id = "lidar";
  cloud.points[5].intensity = 0.5F;
  const LabelledCloud before = cloud;
  GroundLabeler(GroundLabelerConfig{}).label(cloud);
  EXPECT_EQ(cloud.header.frame_id, "lidar");
  ASSERT_EQ(cloud.size(), before.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
  {
    ASSERT_EQ(std::memcmp(cloud.points[i].data, before.points[i].data, sizeof(cloud.points[i].data)), 0);
    ASSERT_EQ(cloud.points[i].intensity, before.points[i].intensity);
    ASSERT_EQ(cloud.points[i].label == kIgnoredId, hits[i] == kMissed);
  }
}

TEST(GroundLabeler, RefusesWhatContradictsItself)
{
  LabelledCloud cloud = emptyCloud(4, 8);
  cloud.points.resize(31);
  GroundLabeler labeler{GroundLabelerConfig{}};
  EXPECT_EQ(messageOf([&] { labeler.label(cloud); }), "expected width x height points, found a cloud of 8 x 4 with 31");
  GroundLabelerConfig config;
  config.ground_height_m = -1.0;
  EXPECT_NE(messageOf([&] { GroundLabeler{config}; }).find("ground_height_m"), std::string::npos);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
