#include "labelled_scene.h"
#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr int kBody = 0;  // the first box

/// A car on four wheels, its nearest corner at (x, y): 4.2 x 1.8 x 1.5 m, 0.22 m over the ground.
std::vector<SceneBox> carAt(float x, float y)
{
  std::vector<SceneBox> boxes = {{{x, y, 0.22F}, {x + 4.2F, y + 1.8F, 0.9F}},
                                 {{x + 1.0F, y + 0.1F, 0.9F}, {x + 3.4F, y + 1.7F, 1.5F}}};
  for (const float along : {0.5F, 3.1F})
    for (const float across : {0.0F, 1.6F})
      boxes.push_back({{x + along, y + across, 0.0F}, {x + along + 0.6F, y + across + 0.2F, 0.6F}});
  return boxes;
}

/// As 1,792 firings lie in an image of 2,048 columns: each eighth column is empty.
LabelledCloud withEmptyColumns(const LabelledCloud& cloud, std::vector<int>& hits)
{
  LabelledCloud wider = emptyCloud(cloud.height, cloud.width / 7 * 8);
  std::vector<int> wider_hits(wider.size(), kMissed);
  for (std::uint32_t row = 0; row < wider.height; ++row)
    for (std::uint32_t column = 0; column < wider.width; ++column)
    {
      if (column % 8 == 7) continue;
      const std::size_t from = std::size_t{row} * cloud.width + column / 8 * 7 + column % 8;
      wider.at(column, row) = cloud.points[from];
      wider_hits[std::size_t{row} * wider.width + column] = hits[from];
    }
  hits = wider_hits;
  return wider;
}

/// Share of the car's returns that are labelled as an object; 1 where it has hardly any.
double shareFound(const SensorModel& sensor, const RayScene& scene, GroundLabeler& labeler, bool empty_columns = false)
{
  std::vector<int> hits;
  LabelledCloud cloud = castScene(scene, sensor, 120.0F, hits);
  if (empty_columns) cloud = withEmptyColumns(cloud, hits);
  labeler.label(cloud);
  int count = 0, found = 0;
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i] >= kBody) ++count, found += cloud.points[i].label == kObjectId ? 1 : 0;
  constexpr int kFewest = 30;
  return count < kFewest ? 1.0 : static_cast<double>(found) / count;
}

class CarGrid : public testing::TestWithParam<std::string>
{
};

/// A vehicle may not flicker as it comes nearer.
TEST_P(CarGrid, ACarOnFlatGroundIsFoundAtEveryDistance)
{
  const SensorModel sensor = SensorModel::load(GetParam());
  GroundLabeler labeler{GroundLabelerConfig{}};
  for (const float height : {1.73F, 2.0F})
    for (const float gap : {-0.9F, 1.5F, 2.5F, 3.5F, 5.0F, 8.0F, 12.0F, 20.0F})
      for (float distance = 4.0F; distance < 60.0F; distance += distance < 20.0F ? 1.0F : 4.0F)
      {
        RayScene scene;
        scene.mount_height = height;
        scene.boxes = carAt(distance, gap);
        EXPECT_GE(shareFound(sensor, scene, labeler), 0.5)
            << GetParam() << " at " << height << " m: car " << distance << " m ahead, " << gap << " m to the side";
      }
}

TEST_P(CarGrid, AColumnWithoutAFiringIsNoGap)
{
  SensorModel sensor = SensorModel::load(GetParam());
  sensor.columns = 1792;
  GroundLabeler labeler{GroundLabelerConfig{}};
  for (const float gap : {-0.9F, 3.6F, 5.0F, 12.0F})
    for (float distance = 4.0F; distance < 20.0F; distance += 2.0F)
    {
      RayScene scene;
      scene.mount_height = 1.8F;
      scene.boxes = carAt(distance, gap);
      EXPECT_GE(shareFound(sensor, scene, labeler, true), 0.5)
          << GetParam() << ": car " << distance << " m ahead, " << gap << " m to the side";
    }
}

INSTANTIATE_TEST_SUITE_P(Labeler, CarGrid, testing::ValuesIn(SensorModel::shippedNames()));
}  // namespace
}  // namespace lidar_panoptic_clustering
