// The range-image algorithms on literal little images, where every link can be worked out by hand.
#include "scan_fixture.h"

#include <gtest/gtest.h>

namespace lidar_panoptic_clustering
{
namespace
{
using Ids = std::vector<std::uint32_t>;

/// A flat fan of beams: one point a column at y = 0.1 m steps, 10 m ahead unless told otherwise.
LabelledPoint ahead(int column, float x = 10.0F, std::uint32_t label = kCar, float z = 0.0F)
{
  return labelled(x, 0.2F - 0.1F * static_cast<float>(column), z, label);
}

Ids split(const std::string& algorithm, const LabelledCloud& cloud, ParameterMap parameters = {})
{
  parameters.emplace("field_of_view", std::string("sector"));
  return instancesOf(runRule(algorithm, cloud, parameters));
}

LabelledCloud line(const std::vector<LabelledPoint>& points)
{
  LabelledCloud cloud = emptyCloud(1, static_cast<std::uint32_t>(points.size()));
  std::copy(points.begin(), points.end(), cloud.points.begin());
  return cloud;
}

TEST(Depth, stepInRangePartsNeighbours)
{
  // 0.1 m across at 10 m: 10 degrees are passed where the step in range reaches 0.1 / tan(10 deg) = 0.57 m
  EXPECT_EQ(split("depth", line({ahead(0), ahead(1, 10.5F), ahead(2, 10.5F), ahead(3, 11.2F)})), (Ids{1, 1, 1, 2}));
}

TEST(Depth, thetaDecides)
{
  const LabelledCloud cloud = line({ahead(0), ahead(1, 10.5F)});
  EXPECT_EQ(split("depth", cloud, {{"theta_deg", 5.0}}), (Ids{1, 1}));
  EXPECT_EQ(split("depth", cloud, {{"theta_deg", 20.0}}), (Ids{1, 2}));
}

TEST(Depth, skipsWhatIsNoLinkablePoint)
{
  LabelledPoint gone = ahead(1);
  gone.x = gone.y = gone.z = 0.0F;
  const LabelledPoint road = ahead(2, 10.0F, kRoad), person = ahead(3, 10.0F, kPerson);
  EXPECT_EQ(split("depth", line({ahead(0), gone, road, person, ahead(4)})), (Ids{1, 0, 0, 2, 1}));
}

TEST(Depth, gapIsCountedInPixels)
{
  LabelledCloud cloud = emptyCloud(1, 11);
  cloud.points[0] = ahead(0), cloud.points[9] = ahead(9);
  EXPECT_EQ(split("depth", cloud)[9], 1U);
  std::swap(cloud.points[9], cloud.points[10]);
  EXPECT_EQ(split("depth", cloud)[10], 2U);
  EXPECT_EQ(split("depth", cloud, {{"max_gap_px", 10}})[10], 1U);
}

TEST(Depth, metricCapPartsWhatTheAngleJoins)
{
  const LabelledCloud cloud = line({labelled(10.0F, 0.0F, 0.0F, kCar), labelled(10.0F, 1.5F, 0.0F, kCar)});
  EXPECT_EQ(split("depth", cloud), (Ids{1, 1}));
  EXPECT_EQ(split("depth", cloud, {{"max_distance_m", 1.0}}), (Ids{1, 2}));
}

TEST(Depth, columnsLinkOverOtherRows)
{
  LabelledCloud cloud = emptyCloud(3, 5);
  cloud.points[1] = ahead(1, 10.0F, kCar, 0.4F);
  cloud.points[2 * 5 + 1] = ahead(1);
  cloud.points[2 * 5 + 4] = ahead(4, 20.0F);
  EXPECT_EQ(split("depth", cloud), (Ids{0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2}));
}

TEST(Depth, turnCloses)
{
  const LabelledCloud cloud = line({ahead(0), ahead(1, 30.0F), ahead(2)});
  EXPECT_EQ(instancesOf(runRule("depth", cloud, {{"max_gap_px", 1}, {"field_of_view", std::string("full_turn")}})),
            (Ids{1, 2, 1}));
  EXPECT_EQ(split("depth", cloud, {{"max_gap_px", 1}}), (Ids{1, 2, 3}));
}

TEST(ScanLineRun, runsBreakAtHalfAMetre)
{
  EXPECT_EQ(split("scan_line_run", line({labelled(10, 0, 0, kCar), labelled(10, 0.49F, 0, kCar),
                                         labelled(10, 1.0F, 0, kCar), labelled(10, 1.2F, 0, kCar)})),
            (Ids{1, 1, 2, 2}));
}

TEST(ScanLineRun, runsGoOnBehindOtherClasses)
{
  EXPECT_EQ(split("scan_line_run", line({ahead(0), ahead(1, 5.0F, kPerson), ahead(2, 5.0F, kRoad), ahead(3)})),
            (Ids{1, 2, 0, 1}));
}

TEST(ScanLineRun, linesJoinBelowAMetreAndOverOneEmptyLine)
{
  LabelledCloud cloud = emptyCloud(5, 3);
  cloud.points[0] = ahead(0, 10.0F, kCar, 1.2F);
  cloud.points[2 * 3] = ahead(0, 10.0F, kCar, 0.3F);       // 0.9 m below, two lines on
  cloud.points[3 * 3 + 2] = ahead(2, 10.0F, kCar, -0.8F);  // more than a metre from both
  EXPECT_EQ(split("scan_line_run", cloud), (Ids{1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 0}));
}

TEST(ScanLineRun, linesFartherThanTheGapDoNotJoin)
{
  LabelledCloud cloud = emptyCloud(4, 1);
  cloud.points[0] = ahead(0), cloud.points[3] = ahead(0, 10.1F);
  EXPECT_EQ(split("scan_line_run", cloud), (Ids{1, 0, 0, 2}));
  EXPECT_EQ(split("scan_line_run", cloud, {{"max_line_gap", 3}}), (Ids{1, 0, 0, 1}));
}

TEST(ScanLineRun, windowCapIsPartOfTheRule)
{
  LabelledCloud cloud = emptyCloud(2, 8);
  cloud.points[0] = labelled(5.0F, 0.4F, 0.0F, kCar);
  cloud.points[8 + 7] = labelled(5.0F, 0.0F, 0.0F, kCar);
  cloud.points[7] = labelled(5.0F, 0.0F, 9.0F, kRoad);  // makes the sector's width measurable
  EXPECT_EQ(split("scan_line_run", cloud)[15], 1U);
  EXPECT_EQ(split("scan_line_run", cloud, {{"max_window_px", 6}})[15], 2U);
}

TEST(Refinement, smallInstancesGetNoId)
{
  const LabelledCloud cloud = line({ahead(0, 30.0F), ahead(1), ahead(2)});
  EXPECT_EQ(split("depth", cloud), (Ids{1, 2, 2}));
  EXPECT_EQ(split("depth", cloud, {{"min_points", 2}}), (Ids{0, 1, 1}));
}

TEST(ClassPolicy, groupsAndAnyJoinClasses)
{
  const LabelledCloud cloud = line({ahead(0), ahead(1, 10.0F, kTruck), ahead(2, 10.0F, kPerson)});
  for (const auto& algorithm : {"depth", "scan_line_run", "euclidean"})
  {
    EXPECT_EQ(split(algorithm, cloud), (Ids{1, 2, 3}));
    EXPECT_EQ(split(algorithm, cloud, {{"class_policy", std::string("group")}}), (Ids{1, 1, 2}));
    EXPECT_EQ(split(algorithm, cloud, {{"class_policy", std::string("any")}}), (Ids{1, 1, 1}));
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
