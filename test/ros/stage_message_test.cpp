#include "reporting/stage_message.h"

#include <gtest/gtest.h>

#include <clocale>
#include <locale>

namespace lidar_panoptic_clustering
{
namespace
{
struct Comma : std::numpunct<char>
{
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(StageMessage, IsTheSameInEveryLocale)
{
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const char* german = std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // nothing where the system has it not
  const auto message = stageMessage("/depth", "depth", 12345, 67, {{"select", 0.5}, {"cluster", 1234.25}});
  const FrameFigures figures = readStageMessage(message);
  std::setlocale(LC_NUMERIC, "C");
  std::locale::global(before);

  ASSERT_EQ(message.values.size(), 4U) << (german != nullptr ? german : "C");
  EXPECT_EQ(message.values[0].value, "12345");
  EXPECT_EQ(message.values[2].value, "0.500000");
  EXPECT_EQ(message.values[3].value, "1234.250000");
  EXPECT_EQ(figures.things, 12345U);
  EXPECT_EQ(figures.totalMilliseconds(), 1234.75);
}

TEST(StageMessage, WhatIsNoNumberIsLeftOut)
{
  auto message = stageMessage("/depth", "depth", 5, 1, {{"select", 0.5}, {"cluster", 1.0}});
  message.values[0].value = "-1", message.values[1].value = "many", message.values[2].value = "1e300";
  const FrameFigures figures = readStageMessage(message);
  EXPECT_EQ(figures.things, 0U);
  EXPECT_EQ(figures.instances, 0U);
  ASSERT_EQ(figures.stages.size(), 1U);
  EXPECT_EQ(figures.stages[0].first, "cluster");
}
}  // namespace
}  // namespace lidar_panoptic_clustering
