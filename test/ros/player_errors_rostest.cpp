#include "player_fixture.h"

namespace lidar_panoptic_clustering
{
namespace
{
TEST_F(Player, EndsAtTheLastScan)
{
  EXPECT_EQ(cloudsUntil("played 3 scans"), 3U);
}

TEST_F(Player, EndsAfterAsManyScansAsAskedFor)
{
  ros::param::set(name_ + "/loop", true);
  ros::param::set(name_ + "/frames", 5);  // the sequence has three
  EXPECT_EQ(cloudsUntil("played 5 scans"), 5U);
}

TEST_F(Player, ShortScanEndsItOrIsSkippedAsConfigured)
{
  writeFile(file("velodyne", 1, ".bin"), scanPoints(1), 100);
  EXPECT_EQ(cloudsUntil("000001.bin: expected a multiple of 16 bytes, found 100"), 1U);
  loader_.clear();
  ros::param::set(name_ + "/on_error", "skip");
  EXPECT_EQ(cloudsUntil("played 2 scans"), 2U);
}

TEST_F(Player, LabelsOfAnotherLengthEndItOrAreSkippedAsConfigured)
{
  writeFile(file("labels", 2, ".label"), scanLabels(), 80);
  EXPECT_EQ(cloudsUntil("000002.label: expected 24 labels, one a point, found 20"), 2U);
  loader_.clear();
  ros::param::set(name_ + "/on_error", "skip");
  EXPECT_EQ(cloudsUntil("played 2 scans"), 2U);
}

TEST_F(Player, MissingHalfOfAScanIsNoticed)
{
  fs::remove(file("velodyne", 0, ".bin"));
  ros::param::set(name_ + "/on_error", "skip");
  EXPECT_EQ(cloudsUntil("played 2 scans"), 2U);
  loader_.clear();
  ros::param::set(name_ + "/on_error", "stop");
  EXPECT_EQ(cloudsUntil("000000.bin"), 0U);
}

TEST_F(Player, StopsWhenNoScanOfALoopCanBePlayed)
{
  ros::param::set(name_ + "/loop", true);
  ros::param::set(name_ + "/on_error", "skip");
  for (int scan = 0; scan < 3; ++scan) fs::remove(file("labels", scan, ".label"));
  EXPECT_EQ(cloudsUntil("played 0 scans"), 0U);
}

TEST_F(Player, RefusesWhatItCannotPlay)
{
  fs::remove_all(sequence() / "predictions");
  ros::param::set(name_ + "/semantics", root_.string());
  expectRefused((sequence() / "predictions").string());
  ros::param::del(name_ + "/semantics");

  ros::param::set(name_ + "/on_error", "ignore");
  expectRefused("'on_error': expected one of 'stop' 'skip', got 'ignore'");
  ros::param::set(name_ + "/on_error", "stop");
  ros::param::set(name_ + "/rate_hz", 0.0);
  expectRefused("'rate_hz': expected a number from 0.01 to 1000, got 0");
  ros::param::set(name_ + "/rate_hz", 10.0);
  ros::param::set(name_ + "/frame_id", "/velodyne");
  expectRefused("frame_id");
  ros::param::set(name_ + "/frame_id", "velodyne");

  ros::param::set(name_ + "/sequence", 8);
  expectRefused("no such folder: " + (root_ / "sequences" / "08").string());
  ros::param::set(name_ + "/dataset", "");
  expectRefused("dataset");
}

}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "player_errors_test");
}
