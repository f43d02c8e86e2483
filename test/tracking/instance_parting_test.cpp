#include "lidar_panoptic_clustering/tracking/point_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
std::shared_ptr<const ClassTable> kitti()
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  return table;
}

/// Scans of rectangles that are filled with points 5 cm apart, 10 a second.
class InstancePartingTest : public testing::Test
{
protected:
  void begin(int scan) { tracker_.begin(100000 * scan, Eigen::Isometry3d::Identity()), owner_.clear(); }
  /// A rectangle along the axes; `owner`: whose points they are.
  void add(int owner, std::uint32_t instance, const std::string& name, double x, double y, double length, double width)
  {
    const ClassIndex class_index = kitti()->findByName(name);
    for (double along = -0.5 * length; along <= 0.5 * length + 1e-6; along += 0.05)
      for (double across = -0.5 * width; across <= 0.5 * width + 1e-6; across += 0.05)
      {
        tracker_.add(instance, class_index, static_cast<float>(x + along), static_cast<float>(y + across), 0.5F);
        owner_.push_back(owner);
      }
  }
  /// The ids that each owner's points have.
  std::map<int, std::set<std::uint32_t>> track()
  {
    tracker_.finish();
    std::map<int, std::set<std::uint32_t>> ids;
    for (std::size_t i = 0; i < owner_.size(); ++i) ids[owner_[i]].insert(tracker_.objectOf(i).track);
    return ids;
  }

private:
  PointTracker tracker_{kitti()};
  std::vector<int> owner_;
};

TEST_F(InstancePartingTest, TwoPeopleWhoWereNeverSeenApartAreTwo)
{
  std::set<std::uint32_t> first, second;
  for (int k = 0; k < 20; ++k)
  {
    begin(k);
    const bool is_merged = k < 10;
    add(1, 1, "person", 10.0 + 0.1 * k, 0.0, 0.3, 0.5);
    add(2, is_merged ? 1 : 2, "person", 10.75 + 0.1 * k, 0.2, 0.3, 0.5);
    auto ids = track();
    first.insert(ids[1].begin(), ids[1].end());
    second.insert(ids[2].begin(), ids[2].end());
  }
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_NE(*first.begin(), *second.begin());
}

TEST_F(InstancePartingTest, ThreeAbreastWhoAreHardlyLargerThanOneAreThree)
{
  std::map<int, std::set<std::uint32_t>> all;
  for (int k = 0; k < 10; ++k)
  {
    begin(k);
    for (int who = 0; who < 3; ++who) add(who, 1, "person", 10.0 + 0.1 * k, 0.6 * who, 0.2, 0.3);
    for (const auto& [who, ids] : track()) all[who].insert(ids.begin(), ids.end());
  }
  std::set<std::uint32_t> different;
  for (const auto& [who, ids] : all)
  {
    EXPECT_EQ(ids.size(), 1U) << who;
    different.insert(ids.begin(), ids.end());
  }
  EXPECT_EQ(different.size(), 3U);
}

TEST_F(InstancePartingTest, LegsThatAreApartAreOnePerson)
{
  begin(0);
  add(1, 1, "person", 10.0, 0.0, 0.15, 0.2);  // hind foot
  add(1, 1, "person", 10.3, 0.0, 0.2, 0.5);   // body
  add(1, 1, "person", 10.7, 0.0, 0.15, 0.2);  // fore foot, 0.23 m before it
  EXPECT_EQ(track()[1].size(), 1U);
}

TEST_F(InstancePartingTest, ThePartOfATornCarThatAScanJoinsToTheNextCarStaysItsOwn)
{
  for (const double slope : {0.0, 0.4142})  // along x, and 22.5 degrees off: a car a row, 6 m apart
  {
    SCOPED_TRACE(slope);
    std::map<int, std::set<std::uint32_t>> ids;
    for (int k = 0; k < 20; ++k)
    {
      begin(100 * (slope > 0.0) + k);
      const bool is_torn = k >= 15 && k % 2 == 1;
      for (int slice = 0; slice < 45; ++slice)
      {
        const double x = 10.0 + 0.1 * slice, y = 5.0 + slope * (x - 10.0);
        add(1, is_torn && slice > 33 ? 2 : 1, "car", x, y, 0.05, 1.6);
        add(2, 2, "car", x + 5.2, y + 5.2 * slope, 0.05, 1.6);
      }
      for (const auto& [car, now] : track()) ids[car].insert(now.begin(), now.end());
    }
    EXPECT_EQ(ids[1].size(), 1U);
    EXPECT_EQ(ids[2].size(), 1U);
    EXPECT_NE(ids[1], ids[2]);
  }
}

TEST_F(InstancePartingTest, TwoWhoWereSeenApartStayTwoWhileTheyPassEachOther)
{
  std::map<int, std::set<std::uint32_t>> ids;
  for (int k = 0; k < 40; ++k)
  {
    begin(k);
    const double x = 10.0 + 0.1 * (k - 20), apart = std::abs(x - 10.0);
    add(1, 1, "person", 10.0, 0.0, 0.3, 0.5);
    add(2, apart < 0.8 ? 1 : 2, "person", x, 0.5, 0.3, 0.4);  // shoulder to shoulder: no hole, hardly larger than one
    for (const auto& [who, now] : track()) ids[who].insert(now.begin(), now.end());
  }
  EXPECT_EQ(ids[1].size(), 1U);
  EXPECT_EQ(ids[2].size(), 1U);
  EXPECT_NE(ids[1], ids[2]);
}

TEST_F(InstancePartingTest, CarsThatAScanMergesStayTwoThoughItTearsTheirOtherEndsOff)
{
  std::map<int, std::set<std::uint32_t>> ids;
  for (int k = 0; k < 20; ++k)
  {
    begin(k);
    const bool is_merged = k == 15;
    for (int slice = 0; slice < 45; ++slice)
    {
      const double x = 10.0 + 0.1 * slice;
      add(1, is_merged && slice < 20 ? 3 : 1, "car", x, 5.0, 0.05, 1.6);
      add(2, !is_merged ? 2 : slice > 24 ? 4 : 1, "car", x + 5.2, 5.0, 0.05, 1.6);
    }
    for (const auto& [car, now] : track()) ids[car].insert(now.begin(), now.end());
  }
  EXPECT_EQ(ids[1].size(), 1U);
  EXPECT_EQ(ids[2].size(), 1U);
  EXPECT_NE(ids[1], ids[2]);
}

TEST_F(InstancePartingTest, OneWithPointsAllOverStaysOneHoweverLarge)
{
  for (int k = 0; k < 5; ++k)
  {
    begin(k);
    add(1, 1, "person", 10.0, 0.0, 1.3, 0.5);  // with outstretched arms
    add(2, 2, "car", 10.0, 8.0, 1.5, 1.8);
    add(2, 2, "car", 14.0, 8.0, 1.5, 1.8);  // two ends of a van, with nothing in between
    auto ids = track();
    EXPECT_EQ(ids[1].size(), 1U);
    EXPECT_EQ(ids[2].size(), 1U);
  }
}

TEST_F(InstancePartingTest, ACarThatWasTornAtFirstIsNotPartedOnceItIsWhole)
{
  std::set<std::uint32_t> ids;
  for (int k = 0; k < 15; ++k)
  {
    begin(k);
    const bool is_torn = k < 4;
    add(1, 1, "car", 8.5, 3.0, 1.5, 1.8);
    add(1, is_torn ? 2 : 1, "car", 11.0, 3.0, 1.8, 1.8);
    if (!is_torn) add(1, 1, "car", 9.7, 3.0, 1.0, 1.8);
    const auto now = track().at(1);
    if (is_torn) continue;
    EXPECT_EQ(now.size(), 1U) << k;
    ids.insert(now.begin(), now.end());
  }
  EXPECT_EQ(ids.size(), 1U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
