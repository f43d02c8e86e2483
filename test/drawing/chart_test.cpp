#include "lidar_panoptic_clustering/drawing/chart.h"
#include "drawing/axis.h"
#include "drawing_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kRed = 0xFF0000, kGreen = 0x00FF00;
}  // namespace

TEST_F(Drawing, barsAreAsHighAsTheirValues)
{
  BarChart chart;
  chart.frame.width_px = 800, chart.frame.height_px = 450;
  chart.categories = {"a", "b"};
  chart.series = {{"first", {100.0, 50.0}, kRed}, {"second", {NAN, 25.0}, kGreen}};
  chart.decimals = -1;
  drawChart(chart, file("bars.png"));
  const Canvas picture = Canvas::readPng(file("bars.png"));
  ASSERT_EQ(picture.width(), 800);
  ASSERT_EQ(picture.height(), 450);

  // the legend's squares are above the plot, the rest belongs to the bars: 150 and 25 units of one width
  const Box plot{0.0, 75.0, 800.0, 375.0};
  const double red = static_cast<double>(countPixels(picture, plot, kRed));
  const double green = static_cast<double>(countPixels(picture, plot, kGreen));
  ASSERT_GT(green, 0.0);
  EXPECT_NEAR(red / green, 150.0 / 25.0, 0.15);
}

TEST_F(Drawing, chartsOfAnySortGiveAPicture)
{
  drawChart(BarChart{}, file("no_bars.png"));
  drawChart(LineChart{}, file("no_lines.png"));
  LineChart chart;
  chart.x.logarithmic = chart.y.logarithmic = true;
  chart.frame.references = {{100.0, "10 Hz"}, {0.0, "not on a logarithmic axis"}};
  for (int s = 0; s < 8; ++s) chart.series.push_back({"series", {{1000.0, 5.0}, {NAN, 7.0}, {1e6, 20.0 * (s + 1)}}});
  drawChart(chart, file("lines.png"));
  BarChart one;
  one.categories = {"a category with a name that does not fit anywhere at all"};
  one.series = {{"negative", {-3.0}}};
  one.y.max = -5.0;  // zero and the bar are on the axis all the same
  drawChart(one, file("one.png"));
  EXPECT_EQ(Canvas::readPng(file("lines.png")).width(), 1600);
  EXPECT_EQ(fileCount(), 4U);
}

TEST_F(Drawing, unwritableChartIsNamed)
{
  const std::string missing = file("no/such/folder.png");
  EXPECT_THROW(drawChart(LineChart{}, missing), std::runtime_error);
  EXPECT_NE(messageOf([&] { drawChart(BarChart{}, missing); }).find(missing), std::string::npos);
}

TEST_F(Drawing, wrongChartsAreRefused)
{
  BarChart bars;
  bars.categories = {"a", "b"};
  bars.series = {{"short one", {1.0}}};
  EXPECT_NE(messageOf([&] { drawChart(bars, file("never.png")); }).find("short one"), std::string::npos);
  bars.series = {{"infinite", {1.0, INFINITY}}};
  EXPECT_THROW(drawChart(bars, file("never.png")), std::invalid_argument);
  bars.series.clear();
  bars.y.logarithmic = true;
  EXPECT_THROW(drawChart(bars, file("never.png")), std::invalid_argument);

  LineChart lines;
  lines.y.logarithmic = true;
  lines.series = {{"zero", {{1.0, 0.0}}}};
  EXPECT_NE(messageOf([&] { drawChart(lines, file("never.png")); }).find("zero"), std::string::npos);
  lines.series.clear();
  lines.y.min = 5.0, lines.y.max = 5.0;
  EXPECT_THROW(drawChart(lines, file("never.png")), std::invalid_argument);
  lines.y = {};
  lines.frame.height_px = 100;
  EXPECT_THROW(drawChart(lines, file("never.png")), std::invalid_argument);
  EXPECT_EQ(fileCount(), 0U);
}

TEST(Ticks, linear)
{
  using Values = std::vector<double>;
  EXPECT_EQ(linearTicks(0.0, 100.0, 6), (Values{0, 20, 40, 60, 80, 100}));
  EXPECT_EQ(linearTicks(0.0, 101.0, 6), (Values{0, 50, 100, 150}));
  EXPECT_EQ(linearTicks(3.0, 17.0, 9), (Values{2, 4, 6, 8, 10, 12, 14, 16, 18}));
  EXPECT_EQ(linearTicks(3.0, 17.0, 8), (Values{0, 5, 10, 15, 20}));
  EXPECT_EQ(linearTicks(-1.0, 1.0, 3), (Values{-1, 0, 1}));
  EXPECT_EQ(linearTicks(0.0, 0.3, 4), (Values{0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(linearTicks(82000.0, 131000.0, 8), (Values{80000, 90000, 100000, 110000, 120000, 130000, 140000}));
  EXPECT_EQ(linearTicks(5.0, 5.0, 3).front(), 5.0) << "an empty range is widened";
  EXPECT_EQ(linearTicks(NAN, NAN, 3), (Values{0, 0.5, 1}));
}

TEST(Ticks, linearCoverTheirRange)
{
  for (const double low : {-1e6, -3.7, -0.001, 0.0, 0.12, 41.0})
    for (const double size : {1e-4, 0.3, 1.0, 7.7, 1234.5})
      for (const int max_count : {3, 5, 9})
      {
        const std::vector<double> ticks = linearTicks(low, low + size, max_count);
        EXPECT_LE(static_cast<int>(ticks.size()), max_count);
        EXPECT_GE(static_cast<int>(ticks.size()), 2);
        EXPECT_LE(ticks.front(), low + 1e-6 * size);
        EXPECT_GE(ticks.back(), low + size - 1e-6 * size);
      }
}

TEST(Ticks, logarithmic)
{
  using Values = std::vector<double>;
  EXPECT_EQ(logTicks(1.0, 1000.0), (Values{1, 10, 100, 1000}));
  EXPECT_EQ(logTicks(3.0, 4000.0), (Values{1, 10, 100, 1000, 10000}));
  EXPECT_EQ(logTicks(3.0, 40.0), (Values{2, 5, 10, 20, 50}));
  EXPECT_EQ(logTicks(10.0, 10.0), (Values{10, 20}));
  EXPECT_EQ(logTicks(0.05, 0.3), (Values{0.05, 0.1, 0.2, 0.5}));
  EXPECT_EQ(logTicks(NAN, NAN), (Values{1, 2, 5, 10}));
}

TEST(Ticks, labels)
{
  EXPECT_EQ(tickLabel(120000.0, 10000.0), "120,000");
  EXPECT_EQ(tickLabel(1234567.0, 1.0), "1,234,567");
  EXPECT_EQ(tickLabel(0.25, 0.05), "0.25");
  EXPECT_EQ(tickLabel(-1000.5, 0.5), "-1,000.5");
  EXPECT_EQ(tickLabel(-1e-20, 0.1), "0.0");
  EXPECT_EQ(tickLabel(999.0, 1.0), "999");
}
}  // namespace lidar_panoptic_clustering
