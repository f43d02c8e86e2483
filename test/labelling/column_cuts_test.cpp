#include "lidar_panoptic_clustering/labelling/column_cuts.h"

#include "labelled_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = ColumnProfile::kNone, kColumns = 16;

/// Columns that go down to the floor, from column `first` on; 0: no return.
std::vector<std::uint32_t> cutsOf(const std::vector<float>& tops, std::uint32_t first = 0)
{
  ColumnProfile profile;
  profile.start(kColumns, first);
  const auto column = [&](std::size_t k) { return static_cast<std::uint32_t>((first + k) % kColumns); };
  for (std::size_t k = 0; k < tops.size(); ++k)
    if (tops[k] > 0.0F) profile.add(column(k), 0.2F), profile.add(column(k), tops[k]);
  profile.find();
  std::vector<std::uint32_t> cuts;
  for (std::size_t k = 0; k < tops.size(); ++k) cuts.push_back(profile.cutOf(column(k)));
  return cuts;
}

using Cuts = std::vector<std::uint32_t>;

TEST(ColumnProfile, HeadAndShouldersAboveACounterAreCut)
{
  EXPECT_EQ(cutsOf({0.9F, 0.9F, 1.3F, 1.7F, 1.4F, 0.9F, 0.9F}), (Cuts{kNone, kNone, 0, 0, 0, kNone, kNone}));
  // at its ends too, where beside it is nothing
  EXPECT_EQ(cutsOf({1.3F, 1.7F, 1.4F, 0.9F}), (Cuts{0, 0, 0, kNone}));
  EXPECT_EQ(cutsOf({0.9F, 1.3F, 1.7F, 1.4F}), (Cuts{kNone, 0, 0, 0}));
}

TEST(ColumnProfile, WhatRisesLessThanAHeadAndItsShouldersIsNot)
{
  EXPECT_EQ(cutsOf({0.9F, 1.34F, 0.9F}), (Cuts{kNone, kNone, kNone}));
  EXPECT_EQ(cutsOf({0.9F, 1.36F, 0.9F}), (Cuts{kNone, 0, kNone}));
  EXPECT_EQ(cutsOf({0.9F, 1.6F, 1.3F, 1.2F}), (Cuts{kNone, 0, 0, 0}));  // an arm's length of something
  EXPECT_EQ(cutsOf({0.3F, 1.1F, 0.3F}), (Cuts{kNone, kNone, kNone}));   // lower than someone who sits
  EXPECT_EQ(cutsOf({0.3F, 1.3F, 0.3F}), (Cuts{kNone, 0, kNone}));
}

TEST(ColumnProfile, TheWholeIsNoCut)
{
  EXPECT_EQ(cutsOf({1.3F, 1.7F, 1.4F}), (Cuts{kNone, kNone, kNone}));
  EXPECT_EQ(cutsOf({1.7F}), (Cuts{kNone}));
}

TEST(ColumnProfile, TwoAtACounterAreTwo)
{
  EXPECT_EQ(cutsOf({1.5F, 1.8F, 0.9F, 0.9F, 1.6F, 1.3F, 0.9F}), (Cuts{0, 0, kNone, kNone, 1, 1, kNone}));
  // as high as the other one's shoulder: no side of its own
  EXPECT_EQ(cutsOf({0.9F, 1.8F, 1.3F, 1.6F, 0.9F}), (Cuts{kNone, 0, kNone, kNone, kNone}));
}

TEST(ColumnProfile, ColumnsWithoutReturnsAreNoSides)
{
  EXPECT_EQ(cutsOf({0.9F, 1.5F, 0.0F, 1.7F, 0.0F, 0.9F}), (Cuts{kNone, 0, 0, 0, 0, kNone}));
}

TEST(ColumnProfile, APartMayGoOnBeyondTheLastColumn)
{
  for (std::uint32_t first = 0; first < kColumns; ++first)
    EXPECT_EQ(cutsOf({0.9F, 1.3F, 1.7F, 1.4F, 0.9F}, first), (Cuts{kNone, 0, 0, 0, kNone})) << first;
}

TEST(ColumnProfile, WhatHangsBesideAHeadIsNoBody)
{
  for (const float depth : {0.1F, 0.4F})  // a pole across, a board
  {
    ColumnProfile profile;
    profile.start(kColumns, 3);
    for (const std::uint32_t column : {3U, 4U, 7U, 8U}) profile.add(column, 1.6F), profile.add(column, 1.6F - depth);
    for (const std::uint32_t column : {5U, 6U}) profile.add(column, 1.6F), profile.add(column, 0.7F);
    EXPECT_EQ(profile.find(), depth < 0.25F ? 1U : 0U);
    EXPECT_EQ(profile.cutOf(5), depth < 0.25F ? 0U : kNone);
    EXPECT_EQ(profile.cutOf(4), kNone);
  }
}

TEST(ColumnProfile, TheNextPartBeginsAnew)
{
  ColumnProfile profile;
  for (int time = 0; time < 2; ++time)
  {
    profile.start(kColumns, 0);
    for (const std::uint32_t column : {0U, 1U, 2U})
      profile.add(column, 0.2F), profile.add(column, column == 1 ? 1.7F : 0.9F);
    EXPECT_EQ(profile.find(), 1U);
    profile.start(kColumns, 1);
    for (const std::uint32_t column : {0U, 1U, 2U}) profile.add(column, 0.2F), profile.add(column, 0.9F);
    EXPECT_EQ(profile.find(), 0U);
  }
}

const SceneBox kCounter{{8.6F, -2.0F, 0.0F}, {9.4F, 2.0F, 0.8F}};

/// With the counter last.
Labelled atCounter(std::vector<SceneBox> boxes, const RaySensor& sensor = {})
{
  boxes.push_back(kCounter);
  return Labelled(sceneOf(boxes), sensor);
}

/// Someone as round as people are, whose chest is 0.1 m before the counter's face.
std::vector<SceneBox> leaning()
{
  std::vector<SceneBox> boxes = personAt(8.65F, 0.0F);
  boxes.push_back({{8.43F, -0.15F, 0.9F}, {8.5F, 0.15F, 1.4F}});
  for (const float y : {-0.35F, 0.25F}) boxes.push_back({{8.56F, y, 0.85F}, {8.7F, y + 0.1F, 1.4F}});
  return boxes;
}

TEST(LabelerCounters, WhoLeansOnACounterIsFoundAndTheCounterIsStructure)
{
  RaySensor lowest_first;
  lowest_first.top_deg = -25.0F, lowest_first.bottom_deg = 3.0F;
  RaySensor astern;  // the image's ends ahead
  astern.from_deg = 360.0F;
  for (const RaySensor& sensor : {RaySensor{}, lowest_first, astern})
  {
    const Labelled scan = atCounter(leaning(), sensor);
    EXPECT_GT(scan.of(7).structure, 0.85);  // but for what of it shows between his legs
    for (const int box : {0, 1, 2, 3, 4, 5, 6}) EXPECT_GT(scan.of(box).object, 0.9) << box;
  }
}

TEST(LabelerCounters, WhoBendsOverItByLessThanAHeadAndItsShouldersIsNot)
{
  std::vector<SceneBox> boxes = leaning();
  for (SceneBox& box : boxes) box.high.z() = std::min(box.high.z(), 1.21F);
  for (const int box : {0, 1, 2, 4, 5, 6}) EXPECT_EQ(atCounter(boxes).of(box).object, 0.0) << box;
}

/// What may be a vehicle is no stall because something stands out of it: something hides its foot.
TEST(LabelerCounters, WhatIsSmoothStaysAnObject)
{
  std::vector<SceneBox> boxes = leaning();
  boxes.push_back({{8.6F, -1.6F, 0.0F}, {10.4F, 1.6F, 0.8F}});
  boxes.push_back({{7.5F, -2.0F, 0.0F}, {7.6F, 2.0F, 0.45F}});
  const Labelled scan(sceneOf(boxes));
  for (const int box : {2, 7}) EXPECT_GT(scan.of(box).object, 0.9) << box;
}

TEST(LabelerCounters, ABareCounterIsStructure)
{
  EXPECT_GT(atCounter({}).of(0).structure, 0.95);
}

TEST(LabelerCounters, APostOrABoardAtACounterIsStructure)
{
  const SceneBox post{{8.52F, -0.05F, 0.0F}, {8.62F, 0.05F, 1.75F}};
  const SceneBox board{{8.55F, -0.3F, 0.0F}, {8.6F, 0.3F, 1.75F}}, notice{{8.47F, -0.15F, 1.1F}, {8.55F, 0.15F, 1.5F}};
  EXPECT_EQ(atCounter({post}).of(0).object, 0.0);
  EXPECT_EQ(atCounter({board, notice}).of(0).object, 0.0);
}

/// As a trunk that stands out of a hedge does.
TEST(LabelerCounters, WhatGoesOnAboveIsNoPerson)
{
  std::vector<SceneBox> boxes = leaning();
  for (SceneBox& box : boxes) box.high.z() = box.high.z() > 1.0F ? 1.75F : box.high.z();
  EXPECT_GT(atCounter(boxes).of(2).object, 0.9);
  boxes.push_back({{8.7F, -1.5F, 1.76F}, {9.8F, 1.5F, 2.6F}});
  EXPECT_EQ(atCounter(boxes).of(2).object, 0.0);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
