#include "lidar_panoptic_clustering/tracking/instance_colors.h"

#include "lidar_panoptic_clustering/core/color_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>
#include <tuple>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr ClassIndex kCarClass = 1, kPersonClass = 6;

Instances::Object object(float x, float y, ClassIndex class_index = kCarClass)
{
  Instances::Object result;
  result.point_count = 1, result.class_index = class_index, result.x = x, result.y = y;
  return result;
}

using Colors = std::vector<std::uint32_t>;

Colors follow(InstanceColors& colors, const std::vector<Instances::Object>& objects)
{
  Instances instances;
  instances.objects = objects;
  return colors.follow(instances);
}

TEST(InstanceColors, SeriesDoesNotRepeatSoonAndIsBright)
{
  std::set<std::uint32_t> seen;
  for (std::uint32_t k = 0; k < 200; ++k)
  {
    const std::uint32_t color = seriesColor(k);
    EXPECT_TRUE(seen.insert(color).second) << k;
    EXPECT_LE(color, 0xFFFFFFU);
    EXPECT_GE(std::max({color >> 16U, color >> 8U & 0xFFU, color & 0xFFU}), 0xBFU);
  }
  seriesColor(0xFFFFFFFFU);
}

TEST(InstanceColors, StayWithAnObjectThatMovesOneMetreAScan)
{
  InstanceColors colors;
  const auto first = follow(colors, {object(-20.5F, 3.0F), object(10.0F, -7.0F)});
  EXPECT_NE(first[0], first[1]);
  for (int i = 1; i <= 50; ++i)
  {
    // over cell borders and through the origin; in the other order, as ids may come
    const float moved = static_cast<float>(i);
    const auto now = follow(colors, {object(10.0F, -7.0F - moved), object(-20.5F + moved, 3.0F)});
    EXPECT_EQ(now, Colors({first[1], first[0]})) << i;
  }
}

TEST(InstanceColors, NewOnesForNewObjectsAndForThoseBeyondTheGate)
{
  InstanceColors colors;
  const auto first = follow(colors, {object(0.0F, 0.0F)});
  const auto second = follow(colors, {object(30.0F, 0.0F), object(0.0F, 1.99F)});
  EXPECT_EQ(second[1], first[0]);
  EXPECT_NE(second[0], first[0]);
  const auto third = follow(colors, {object(0.0F, 1.99F + 2.01F), object(30.0F, 0.0F)});
  EXPECT_EQ(third[1], second[0]);
  EXPECT_NE(third[0], first[0]);
  EXPECT_NE(third[0], second[0]);
}

TEST(InstanceColors, AnotherClassAtTheSamePlaceIsAnotherObject)
{
  InstanceColors colors;
  const auto first = follow(colors, {object(5.0F, 5.0F, kCarClass)});
  const auto second = follow(colors, {object(5.0F, 5.0F, kPersonClass)});
  EXPECT_NE(second[0], first[0]);
}

TEST(InstanceColors, TwoObjectsThatPassEachOtherKeepTheirs)
{
  InstanceColors colors;
  const auto first = follow(colors, {object(0.0F, 0.0F), object(20.0F, 3.0F)});
  for (int i = 1; i <= 20; ++i)  // 1 m a scan, 3 m apart where they meet
  {
    const float moved = static_cast<float>(i);
    EXPECT_EQ(follow(colors, {object(moved, 0.0F), object(20.0F - moved, 3.0F)}), first) << i;
  }
}

TEST(InstanceColors, OneColorIsGivenToOneOnlyTheNearest)
{
  InstanceColors colors;
  const auto first = follow(colors, {object(0.0F, 0.0F)});
  const auto second = follow(colors, {object(0.0F, 1.0F), object(0.0F, -0.5F)});  // it split
  EXPECT_EQ(second[1], first[0]);
  EXPECT_NE(second[0], first[0]);
}

TEST(InstanceColors, ResetForgets)
{
  InstanceColors colors;
  const auto first = follow(colors, {object(0.0F, 0.0F)});
  colors.reset();
  EXPECT_NE(follow(colors, {object(0.0F, 0.0F)})[0], first[0]);
}

/// All pairs within the gate, nearest first: quadratic, without a grid.
Colors bruteForce(const std::vector<Instances::Object>& before, const Colors& colors_before,
                  const std::vector<Instances::Object>& now)
{
  std::vector<std::tuple<float, std::size_t, std::size_t>> pairs;
  for (std::size_t c = 0; c < now.size(); ++c)
    for (std::size_t p = 0; p < before.size(); ++p)
    {
      const float dx = now[c].x - before[p].x, dy = now[c].y - before[p].y;
      if (now[c].class_index == before[p].class_index && dx * dx + dy * dy < 4.0F)
        pairs.emplace_back(dx * dx + dy * dy, c, p);
    }
  std::sort(pairs.begin(), pairs.end());
  Colors colors(now.size(), 0);
  std::set<std::size_t> given, taken;
  for (const auto& [distance, c, p] : pairs)
    if (given.count(p) == 0 && taken.count(c) == 0) colors[c] = colors_before[p], given.insert(p), taken.insert(c);
  return colors;
}

TEST(InstanceColors, CrowdsAgreeWithAllPairs)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-8.0F, 8.0F);
  InstanceColors colors;
  std::vector<Instances::Object> before;
  Colors colors_before;
  for (int scan = 0; scan < 200; ++scan)
  {
    std::vector<Instances::Object> now;
    for (std::size_t i = 0; i < random() % 40; ++i)
      now.push_back(object(place(random), place(random), random() % 2 == 0 ? kCarClass : kPersonClass));
    const Colors found = follow(colors, now), expected = bruteForce(before, colors_before, now);
    ASSERT_EQ(found.size(), now.size());
    const std::set<std::uint32_t> old(colors_before.begin(), colors_before.end());
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      if (expected[i] != 0)
        EXPECT_EQ(found[i], expected[i]);
      else
        EXPECT_EQ(old.count(found[i]), 0U) << "a new object has the colour of an old one";
    }
    before = now, colors_before = found;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
