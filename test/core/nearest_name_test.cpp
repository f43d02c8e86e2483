#include "lidar_panoptic_clustering/core/nearest_name.h"

#include <gtest/gtest.h>

namespace lidar_panoptic_clustering
{
namespace
{
TEST(EditDistance, CountsLettersExchangedInsertedAndLeftOut)
{
  EXPECT_EQ(editDistance("", ""), 0U);
  EXPECT_EQ(editDistance("", "abc"), 3U);
  EXPECT_EQ(editDistance("columns", "columns"), 0U);
  EXPECT_EQ(editDistance("colums", "columns"), 1U);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(editDistance("sitting", "kitten"), 3U);
}

TEST(NearestName, IsTheOneMeant)
{
  const std::vector<std::string> names = {"columns", "distance_m", "min_points", "max_range_m", "sensor"};
  EXPECT_EQ(nearestName("colums", names), "columns");
  EXPECT_EQ(nearestName("Columns", names), "columns");
  EXPECT_EQ(nearestName("min_point", names), "min_points");
  EXPECT_EQ(nearestName("distance", names), "distance_m");
  EXPECT_EQ(nearestName("range", names), "max_range_m") << "a part of it";
  EXPECT_EQ(nearestName("zzz", names), "");
  EXPECT_EQ(nearestName("m", names), "") << "a part of many";
  EXPECT_EQ(nearestName("", names), "");
  EXPECT_EQ(nearestName("columns", {}), "");
}

TEST(NearestName, IsTheFirstOfEquals)
{
  EXPECT_EQ(nearestName("rowa", {"rows", "rowb"}), "rows");
}
}  // namespace
}  // namespace lidar_panoptic_clustering
