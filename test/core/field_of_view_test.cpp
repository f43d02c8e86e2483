// Whether a scan closes on itself is found from its points.
#include "scan_fixture.h"

#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kDegree = 3.14159265F / 180.0F;

/// A car at 10 m in every column; `turn_deg` is the angle that all columns together look at, ahead.
LabelledCloud ringOfCars(std::uint32_t columns, float turn_deg)
{
  LabelledCloud cloud = emptyCloud(16, columns);
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < columns; ++column)
    {
      const float azimuth =
          kDegree * turn_deg * (0.5F - (static_cast<float>(column) + 0.5F) / static_cast<float>(columns));
      cloud.points[row * columns + column] =
          labelled(10.0F * std::cos(azimuth), 10.0F * std::sin(azimuth), -0.1F * static_cast<float>(row), kCar);
    }
  return cloud;
}

ThingScan select(const LabelledCloud& cloud, const std::string& field_of_view = "auto")
{
  SelectionConfig config;
  config.field_of_view = field_of_view;
  ThingScan scan;
  selectThings(cloud, *kittiTable(), config, scan);
  return scan;
}

TEST(FieldOfView, AFullTurnClosesOnItself)
{
  const ThingScan scan = select(ringOfCars(1024, 360.0F));
  EXPECT_TRUE(scan.full_turn);
  EXPECT_NEAR(scan.column_angle, 360.0F / 1024.0F * kDegree, 1e-5F);
}

TEST(FieldOfView, ASectorDoesNotAndHasNarrowerColumns)
{
  for (const float turn_deg : {60.0F, 120.0F, 270.0F})
  {
    const ThingScan scan = select(ringOfCars(600, turn_deg));
    EXPECT_FALSE(scan.full_turn) << turn_deg;
    EXPECT_NEAR(scan.column_angle, turn_deg / 600.0F * kDegree, 1e-4F) << turn_deg;
  }
}

TEST(FieldOfView, MissingReturnsDoNotChangeIt)
{
  for (const float turn_deg : {360.0F, 90.0F})
  {
    LabelledCloud cloud = ringOfCars(1024, turn_deg);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (i % 7 < 4) cloud.points[i] = LabelledPoint();
    EXPECT_EQ(select(cloud).full_turn, turn_deg == 360.0F) << turn_deg;
  }
}

TEST(FieldOfView, ATurnIsTakenToBeFullWhereTooFewReturnsTell)
{
  LabelledCloud cloud = emptyCloud(16, 600);
  cloud.points[300] = labelled(10.0F, 0.0F, 0.0F, kCar);
  cloud.points[301] = labelled(10.0F, -0.1F, 0.0F, kCar);
  EXPECT_TRUE(select(cloud).full_turn);
}

TEST(FieldOfView, WhatIsSetHolds)
{
  EXPECT_FALSE(select(ringOfCars(1024, 360.0F), "sector").full_turn);
  EXPECT_TRUE(select(ringOfCars(1024, 90.0F), "full_turn").full_turn);
  SelectionConfig half;
  half.field_of_view = "half";
  EXPECT_THROW(validateParameters(half), std::invalid_argument);
}

TEST(FieldOfView, SimulatedSensorsAreFullTurns)
{
  for (const std::string& name : SensorModel::shippedNames())
  {
    LidarSimulator simulator(SensorModel::load(name));
    PanopticCloud scan;
    simulator.scan(5, scan);
    LabelledCloud cloud(scan.width, scan.height);
    for (std::size_t k = 0; k < scan.size(); ++k)
    {
      cloud.points[k].getVector4fMap() = scan.points[k].getVector4fMap();
      cloud.points[k].label = scan.points[k].label;
    }
    EXPECT_TRUE(select(cloud).full_turn) << name;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
