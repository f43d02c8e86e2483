#include "reporting/frame_report.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
FrameFigures frame(std::uint64_t stamp_us, double cluster_ms = 2.0)
{
  FrameFigures figures;
  figures.stamp_us = stamp_us;
  figures.points = 1000, figures.things = 100, figures.instances = 10;
  figures.stages = {{"select", 0.5}, {"cluster", cluster_ms}};
  return figures;
}

std::string lastLine(const std::string& text)
{
  const auto end = text.find_last_not_of('\n') + 1;
  const auto begin = text.rfind('\n', end - 1) + 1;
  return text.substr(begin, end - begin);
}

/// The line of the summary that begins with `algorithm`.
std::string rowOf(const std::string& summary, const std::string& algorithm)
{
  const auto begin = summary.find("\n" + algorithm) + 1;
  return summary.substr(begin, summary.find('\n', begin) - begin);
}

TEST(Quantile, IsTheNearestRank)
{
  EXPECT_EQ(quantileOf({}, 0.5), 0.0);
  EXPECT_EQ(quantileOf({7.0}, 0.95), 7.0);
  EXPECT_EQ(quantileOf({4.0, 1.0, 3.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantileOf({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantileOf({3.0, 1.0, 2.0}, 1.0), 3.0);
  EXPECT_EQ(quantileOf({3.0, 1.0, 2.0}, 0.0), 1.0);
  std::vector<double> twenty;
  for (int i = 20; i > 0; --i) twenty.push_back(i);
  EXPECT_EQ(quantileOf(twenty, 0.95), 19.0);
}

TEST(FrameReport, PrintsTheHeadOnceAndALineAFrame)
{
  FrameReport report({"depth"}, 0);
  EXPECT_EQ(report.add("depth", frame(1)),
            " frame algorithm       points   things  instances   select  cluster    total   [ms a stage]\n"
            "     1 depth             1000      100         10     0.50     2.00     2.50\n");
  EXPECT_EQ(report.add("depth", frame(2)),
            "     2 depth             1000      100         10     0.50     2.00     2.50\n");
  EXPECT_THROW(report.add("euclidean", frame(3)), std::invalid_argument);
}

TEST(FrameReport, IsCompleteWhenTheSlowestReachesTheLimit)
{
  FrameReport report({"depth", "supervoxel"}, 2);
  report.add("depth", frame(1));
  report.add("depth", frame(2));
  EXPECT_EQ(report.add("depth", frame(3)), "");  // beyond the limit
  report.add("supervoxel", frame(1));
  EXPECT_FALSE(report.complete());
  EXPECT_EQ(lastLine(report.summary()), "ended early: 1 of 2 frames of the slowest algorithm");
  report.add("supervoxel", frame(3));
  EXPECT_TRUE(report.complete());
  EXPECT_EQ(lastLine(report.summary()), "done: 2 of 2 frames of each algorithm");
}

TEST(FrameReport, WithoutALimitItIsDoneWheneverItEnds)
{
  FrameReport report({"depth"}, 0);
  EXPECT_FALSE(report.complete());
  EXPECT_EQ(lastLine(report.summary()).substr(0, 5), "done:");
}

TEST(FrameReport, CountsTheScansDroppedBetweenFirstAndLastFrame)
{
  FrameReport report({"depth", "supervoxel"}, 3);
  for (const std::uint64_t stamp : {10, 20, 30, 40, 50, 60}) report.sent(stamp);
  for (const std::uint64_t stamp : {20, 30, 40}) report.add("depth", frame(stamp));
  for (const std::uint64_t stamp : {20, 40, 60}) report.add("supervoxel", frame(stamp));
  //                                                  algorithm     frames dropped
  EXPECT_EQ(rowOf(report.summary(), "depth").substr(0, 28), "depth              3       0");
  EXPECT_EQ(rowOf(report.summary(), "supervoxel").substr(0, 28), "supervoxel         3       2");
}

TEST(FrameReport, SumsUpByMediansAndTails)
{
  FrameReport report({"depth"}, 3);
  report.add("depth", frame(1, 9.5));
  report.add("depth", frame(2, 1.5));
  report.add("depth", frame(3, 3.5));
  EXPECT_EQ(rowOf(report.summary(), "depth"),
            "depth              3       0     1000      100         10     0.50     3.50     4.00    10.00    10.00");
}
}  // namespace
}  // namespace lidar_panoptic_clustering
