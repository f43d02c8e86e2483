#include "lidar_panoptic_clustering/labelling/ground_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
/// Points on a tilted plane 1.7 m below the sensor, every twentieth 1 m above it, every seventh missing.
LabelledCloud tiltedGround(std::uint32_t size)
{
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-60.0F, 60.0F);
  LabelledCloud cloud(size, 1);
  for (std::uint32_t i = 0; i < size; ++i)
  {
    LabelledPoint& p = cloud.points[i];
    p.x = place(random), p.y = place(random);
    p.z = 0.02F * p.x - 0.03F * p.y - 1.7F + (i % 20 == 0 ? 1.0F : 0.0F);
    if (i % 7 == 0) p.x = i % 2 == 0 ? kNaN : p.x, p.y = i % 2 == 0 ? p.y : kNaN;
  }
  return cloud;
}

/// Four points at once, and what is left at the end of a cloud, are what a point is alone.
TEST(GroundSurface, HeightsOfACloudAreThoseOfItsPoints)
{
  for (const std::uint32_t size : {4000U, 4001U, 4002U, 4003U})
  {
    const LabelledCloud cloud = tiltedGround(size);
    GroundSurface surface;
    std::vector<GroundedReturn> returns(size);
    ASSERT_TRUE(surface.find(cloud, 300.0F, 0.08F));
    surface.locate(cloud, 0, size / 3, returns);
    surface.locate(cloud, size / 3, size, returns);
    for (std::uint32_t i = 0; i < size; ++i)
    {
      const LabelledPoint& p = cloud.points[i];
      ASSERT_EQ(returns[i].isReturn(), i % 7 != 0);
      if (!returns[i].isReturn())
      {
        EXPECT_TRUE(std::isnan(returns[i].height));
        continue;
      }
      EXPECT_EQ(returns[i].range, std::sqrt(p.x * p.x + p.y * p.y));
      EXPECT_EQ(returns[i].height, surface.heightOf(p.x, p.y, p.z)) << "point " << i << " of " << size;
      EXPECT_NEAR(returns[i].height, i % 20 == 0 ? 1.0F : 0.0F, 0.12F);
    }
  }
}

TEST(GroundPlane, IsFoundThroughWhatStandsOnIt)
{
  std::vector<LowReturn> lowest;
  for (int x = -10; x < 10; ++x)
    for (int y = -10; y < 10; ++y)
    {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const float above = (x + y) % 3 == 0 ? 1.5F : 0.0F;
      lowest.push_back({fx, fy, 0.1F * fx - 0.05F * fy - 2.0F + above});
    }
  SlopedPlane plane;
  ASSERT_TRUE(findGroundPlane(lowest, plane));
  EXPECT_NEAR(plane.slope_x, 0.1F, 1e-3F);
  EXPECT_NEAR(plane.slope_y, -0.05F, 1e-3F);
  EXPECT_NEAR(plane.offset, -2.0F, 1e-3F);
}

TEST(GroundPlane, IsNoneAboveTheSensorAndOfAFewReturns)
{
  SlopedPlane plane;
  EXPECT_FALSE(findGroundPlane({}, plane));
  EXPECT_FALSE(findGroundPlane(std::vector<LowReturn>(9, {1.0F, 1.0F, -1.7F}), plane));
  std::vector<LowReturn> above;
  for (int k = 0; k < 50; ++k) above.push_back({static_cast<float>(k % 7), static_cast<float>(k % 5), 2.0F});
  EXPECT_FALSE(findGroundPlane(above, plane));
}
}  // namespace
}  // namespace lidar_panoptic_clustering
