#include "tracker_scene.h"

#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
class TrackerPartsTest : public TrackerScene
{
};

TEST_F(TrackerPartsTest, TwoPeopleWhoWereOneInstanceAtFirstHaveTwoIdsOnceTheyAreTwo)
{
  std::map<std::uint32_t, std::uint32_t> ids;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    const bool is_merged = k < 8;
    person(1, 10.0 + 0.1 * k, 0.0);
    person(is_merged ? 1 : 2, 10.0 + 0.1 * k, 0.7);
    for (const auto& [instance, object] : track(0.1 * k))
    {
      if (is_merged) continue;
      EXPECT_EQ(ids.emplace(instance, object.track).first->second, object.track) << k;
    }
  }
  EXPECT_NE(ids[1], ids[2]);
}

TEST_F(TrackerPartsTest, AFragmentThatHadAnIdOfItsOwnTakesThatOfTheObject)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    const bool is_torn = k == 15 || k == 16;
    if (k == 14) add(2, "car", 12.9, 3.0, 0.6, 0.3);  // beyond the outline: an object of its own
    if (is_torn)
    {
      add(1, "car", 9.2, 3.0, 2.6, 1.8);
      add(2, "car", 11.6, 3.0, 1.4, 1.8);
    }
    else
      car(1, 10.0, 3.0);
    const auto objects = track(0.1 * k);
    if (k == 0) id = objects.at(1).track;
    EXPECT_EQ(objects.at(1).track, id) << k;
    if (is_torn)
    {
      EXPECT_EQ(objects.at(2).track, id) << k;
    }
  }
}

TEST_F(TrackerPartsTest, TheEndOfAFarCarThatHadAnIdOfItsOwnForLongHasTheOlderOne)
{
  for (const double yaw : {0.0, 0.3927})  // 22.5 degrees: half way between two axes
  {
    SCOPED_TRACE(yaw);
    const double start_s = yaw > 0.0 ? 100.0 : 0.0;
    const double ahead_x = 1.7 * std::cos(yaw), ahead_y = 1.7 * std::sin(yaw);
    std::uint32_t id = 0;
    for (int k = 0; k < 40; ++k)
    {
      begin();
      add(1, "car", 10.0 - ahead_x, 3.0 - ahead_y, 1.0, 1.7, yaw);
      if (k >= 2 && k % 3 != 0)
        for (const double across : {-0.8, 0.8})  // two corners, 16 points
          add(2, "car", 10.0 + ahead_x - across * std::sin(yaw), 3.0 + ahead_y + across * std::cos(yaw), 0.05, 0.05,
              yaw);
      const auto objects = track(start_s + 0.1 * k);
      if (k == 0) id = objects.at(1).track;
      EXPECT_EQ(objects.at(1).track, id) << k;
      if (k >= 14 && objects.count(2) > 0)
      {
        EXPECT_EQ(objects.at(2).track, id) << k;
      }
    }
  }
}

TEST_F(TrackerPartsTest, CarsOfWhichASideIsSeenStayApart)
{
  std::map<std::uint32_t, std::uint32_t> ids;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    add(1, "car", 10.0, 3.0, 4.5, 0.2);   // the side of one
    add(2, "car", 10.0, 5.2, 4.5, 0.2);   // and of the one behind it
    add(3, "car", 20.0, 3.0, 0.3, 1.7);   // the rear of one
    add(4, "car", 25.5, 3.0, 0.3, 1.7);   // and of the one before it
    add(5, "car", 10.0, -8.0, 0.4, 1.7);  // the fronts of two that are parked side by side
    add(6, "car", 10.0, -5.6, 0.4, 1.7);
    for (const auto& [instance, object] : track(0.1 * k))
      EXPECT_EQ(ids.emplace(instance, object.track).first->second, object.track) << k;
  }
  std::set<std::uint32_t> different;
  for (const auto& [instance, id] : ids) different.insert(id);
  EXPECT_EQ(different.size(), 6U);
}

TEST_F(TrackerPartsTest, OneThatComesOutFromBehindAnotherWithManyTimesThePointsKeepsItsId)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    if (k < 10)
      add(1, "car", 8.05, 3.0, 0.5, 0.2);  // its rear corner
    else if (k >= 15)
      car(1, 10.0, 3.0);
    const auto objects = track(0.1 * k);
    if (objects.empty()) continue;
    if (k == 0) id = objects.at(1).track;
    EXPECT_EQ(objects.at(1).track, id) << k;
  }
}

TEST_F(TrackerPartsTest, ACarThatCameIntoSightInTwoPartsHasTheOlderAndLargerOnesId)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 40; ++k)
  {
    begin();
    const double x = 10.0 + 1.0 * k;
    if (k < 8) add(1, "car", x - 1.5, 3.0, 1.4, 1.7);
    if (k >= 4 && k < 8) add(2, "car", x + 1.9, 3.0, 0.3, 0.1);  // beyond the outline: an id of its own
    // now the whole car, now only the end that had the other id
    if (k >= 8) add(1, "car", k % 2 == 0 ? x : x + 1.0, 3.0, k % 2 == 0 ? 4.5 : 2.5, 1.8);
    const auto objects = track(0.1 * k);
    if (k == 0) id = objects.at(1).track;
    EXPECT_EQ(objects.at(1).track, id) << k;
    if (k == 8)
    {
      EXPECT_FALSE(tracker_.isAlive(id + 1)) << "the fragment's track";
    }
  }
}

TEST_F(TrackerPartsTest, OneThatGoesBehindAPoleComesOutWithItsPointsAndItsId)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 35; ++k)
  {
    begin();
    const double x = 10.0 + 0.8 * k;
    if (k < 15)
      car(1, x, 3.0);
    else if (k == 15)
      add(1, "car", x - 1.6, 3.0, 1.3, 1.5);
    else if (k == 16)
      add(1, "car", x - 2.2, 3.0, 0.05, 0.05);  // a corner, and then nothing
    else if (k >= 26)
      add(1, "car", x + 1.5, 3.0, 1.2, 1.8);  // its front, a second later
    const auto objects = track(0.1 * k);
    if (objects.empty()) continue;
    if (k == 0) id = objects.at(1).track;
    EXPECT_EQ(objects.at(1).track, id) << k;
  }
}

TEST_F(TrackerPartsTest, PartsOfATornObjectHaveItsId)
{
  std::uint32_t id = 0;
  for (int k = 0; k < 30; ++k)
  {
    begin();
    const double x = 10.0 + 0.5 * k;
    const bool is_torn = k >= 10 && k % 2 == 0;
    if (is_torn)
    {
      add(1, "car", x - 1.2, 3.0, 2.1, 1.8);
      add(2, "car", x + 1.5, 3.0, 1.5, 1.8);
    }
    else
      car(1, x, 3.0);
    car(3, x, 9.0);
    const auto objects = track(0.1 * k);
    if (k == 0) id = objects.at(1).track;
    EXPECT_EQ(objects.at(1).track, id) << k;
    if (is_torn)
    {
      EXPECT_EQ(objects.at(2).track, id) << k;
    }
    EXPECT_NE(objects.at(3).track, id);
  }
}

TEST_F(TrackerPartsTest, TwoThatAScanMergesAreToldApartAgain)
{
  std::map<std::uint32_t, std::uint32_t> ids;
  for (int k = 0; k < 40; ++k)
  {
    begin();
    const bool is_merged = k >= 15 && k < 22;
    person(1, 10.0 + 0.1 * k, 0.0);
    person(is_merged ? 1 : 2, 10.0 + 0.1 * k, 0.9);
    const auto objects = track(0.1 * k);
    if (k == 0) ids = {{1, objects.at(1).track}, {2, objects.at(2).track}};
    if (is_merged) continue;
    EXPECT_EQ(objects.at(1).track, ids[1]) << k;
    EXPECT_EQ(objects.at(2).track, ids[2]) << k;
  }
}

TEST_F(TrackerPartsTest, ACarCalledTruckForThreeScansStaysACar)
{
  const ClassIndex is_car = kitti()->findByName("car"), is_truck = kitti()->findByName("truck");
  for (const bool vote : {true, false})
  {
    TrackerConfig config;
    config.vote_over_time = vote;
    tracker_.configure(config);
    std::set<std::uint32_t> ids;
    for (int k = 0; k < 20; ++k)
    {
      begin();
      const bool is_wrong = k >= 8 && k < 11;
      add(1, is_wrong ? "truck" : "car", 10.0, 0.0, 4.5, 1.8);
      const TrackedObject object = track(0.1 * k).at(1);
      ids.insert(object.track);
      EXPECT_EQ(object.class_index, is_wrong && !vote ? is_truck : is_car) << k;
    }
    EXPECT_EQ(ids.size(), 1U);
    tracker_.reset();
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering
