#include "reporting/latency_report.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
LatencyReport::Time at(int ms)
{
  return LatencyReport::Time(std::chrono::milliseconds(ms));
}

/// A scan that goes in at `ms`, comes out `latency` later when it is one millisecond older, and took two less of work.
void pass(LatencyReport& report, int ms, int latency)
{
  const auto stamp = static_cast<std::uint64_t>(ms);
  report.sent(stamp, at(ms));
  report.returned(stamp, at(ms + latency), latency + 1.0);
  report.worked(stamp, latency - 2.0);
}

std::string lineOf(const std::string& text, const std::string& part)
{
  const auto found = text.find(part);
  if (found == std::string::npos) return "";
  const auto begin = text.rfind('\n', found) + 1;
  return text.substr(begin, text.find('\n', found) - begin);
}

std::string lineOf(const LatencyReport& report, const std::string& part)
{
  return lineOf(report.table("graph", "depth"), part);
}

TEST(LatencyReport, PrintsPercentilesOfEachMeasure)
{
  LatencyReport report(0, 20);
  for (int i = 20; i > 0; --i) pass(report, 100 * (21 - i), 10 + i);
  EXPECT_EQ(report.table("one manager", "scan_line_run"),
            "\n"
            "graph            algorithm      scans dropped  milliseconds                  least   median     90 %"
            "     95 %     99 %  longest\n"
            "one manager      scan_line_run     20       0  input to output callback      11.00    20.00    28.00"
            "    29.00    30.00    30.00\n"
            "                                               stamp to output callback      12.00    21.00    29.00"
            "    30.00    31.00    31.00\n"
            "                                               the nodelet's own work         9.00    18.00    26.00"
            "    27.00    28.00    28.00\n"
            "done: 20 of 20 scans\n");
}

TEST(LatencyReport, LeavesOutTheFirstAndStopsAtTheLimit)
{
  LatencyReport report(2, 3);
  for (const int latency : {900, 800, 3, 4}) pass(report, 1000 * latency, latency);
  EXPECT_FALSE(report.complete());
  EXPECT_NE(lineOf(report, "ended early: 2 of 3 scans"), "");
  for (const int latency : {5, 700}) pass(report, 10000000 + latency, latency);
  EXPECT_TRUE(report.complete());
  EXPECT_EQ(lineOf(report, "input to"),
            "graph            depth              3       0  input to output callback       3.00     4.00     5.00"
            "     5.00     5.00     5.00");
  EXPECT_NE(lineOf(report, "done: 3 of 3 scans"), "");
}

TEST(LatencyReport, WithoutALimitItIsDoneWheneverItEnds)
{
  LatencyReport report(0, 0);
  EXPECT_NE(lineOf(report, "done: ended from outside"), "");
  pass(report, 1, 1);
  EXPECT_FALSE(report.complete());
  EXPECT_NE(lineOf(report, "done: ended from outside"), "");
}

TEST(LatencyReport, MatchesByStampInWhicheverOrderTheStreamsCome)
{
  LatencyReport report(0, 3);
  report.sent(1, at(10));
  report.sent(2, at(20));
  report.returned(1, at(31), 22.0);  // while the second one is on its way
  report.returned(2, at(43), 24.0);
  report.worked(1, 5.0);
  EXPECT_FALSE(report.complete());
  report.worked(2, 6.0);
  report.worked(3, 7.0);  // all before the callback of the input had its turn
  report.returned(3, at(55), 26.0);
  report.sent(3, at(30));
  EXPECT_TRUE(report.complete());
  EXPECT_EQ(report.dropped(), 0U);
  EXPECT_NE(lineOf(report, "input to").find("callback      21.00    23.00    25.00"), std::string::npos);
  EXPECT_NE(lineOf(report, "stamp to").find("callback      22.00    24.00    26.00"), std::string::npos);
  EXPECT_NE(lineOf(report, "own work").find("work         5.00     6.00     7.00"), std::string::npos);
}

TEST(LatencyReport, CountsScansWithoutOutputBetweenTheFirstAndTheLast)
{
  LatencyReport report(1, 3);
  report.sent(1, at(1));  // lost before anything came out: the graph was not yet connected
  pass(report, 2, 5);
  report.sent(3, at(3));  // lost in the warm-up
  pass(report, 4, 5);
  report.sent(5, at(5));
  report.sent(6, at(6));
  pass(report, 7, 5);
  EXPECT_EQ(report.dropped(), 2U);
  report.sent(8, at(8));
  EXPECT_EQ(report.dropped(), 2U);  // it may still come
  pass(report, 9, 5);
  EXPECT_EQ(report.dropped(), 3U);
  report.sent(10, at(10));
  EXPECT_TRUE(report.complete());
  EXPECT_EQ(report.dropped(), 3U);
}

TEST(LatencyReport, PassesOverWhatItSawTwiceOrOnOneSideOnly)
{
  LatencyReport report(0, 2);
  report.returned(1, at(5), 5.0);  // its input came before anybody listened
  report.worked(1, 5.0);
  report.sent(2, at(10));
  report.sent(2, at(14));  // roscpp may connect a publisher and a subscriber twice
  report.returned(2, at(17), 7.0);
  report.returned(2, at(18), 8.0);
  report.worked(2, 1.0);
  pass(report, 30, 9);
  EXPECT_TRUE(report.complete());
  EXPECT_EQ(report.dropped(), 0U);
  EXPECT_NE(lineOf(report, "input to").find("callback       7.00     7.00     9.00"), std::string::npos);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
