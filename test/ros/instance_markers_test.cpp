#include "ros/instance_markers.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
using visualization_msgs::Marker;

class InstanceMarkersTest : public testing::Test
{
protected:
  /// A list of `count` cars at `now` [s].
  visualization_msgs::MarkerArrayPtr update(std::size_t count, double now)
  {
    ObjectArray list;
    list.header.frame_id = "lidar";
    list.header.stamp = ros::Time(now - 0.05);
    for (std::size_t k = 0; k < count; ++k)
    {
      Object object;
      object.instance_id = static_cast<std::uint32_t>(k + 1);
      object.class_name = "car";
      object.pose.position.z = -1.0, object.pose.orientation.w = 1.0;
      object.size.x = 4.0, object.size.y = 2.0, object.size.z = 1.5;
      list.objects.push_back(object);
    }
    return markers_.update(list, std::vector<std::uint32_t>(count, 0xFF8000), ros::Time(now));
  }

  InstanceMarkers markers_;
};

using Ids = std::set<std::pair<std::string, int>>;

Ids idsWith(const visualization_msgs::MarkerArray& array, int action)
{
  Ids ids;
  for (const Marker& marker : array.markers)
  {
    if (marker.action != action) continue;
    EXPECT_TRUE(ids.emplace(marker.ns, marker.id).second) << marker.ns << marker.id;
  }
  return ids;
}

TEST_F(InstanceMarkersTest, ListsAllAndDeletesByNameWhatIsNoMore)
{
  const Ids one = {{"boxes", 1}, {"texts", 1}}, two = {{"boxes", 2}, {"texts", 2}};
  Ids three = one;
  three.insert(two.begin(), two.end());
  three.insert({{"boxes", 3}, {"texts", 3}});

  const auto first = update(3, 10.0), second = update(1, 10.1), third = update(2, 10.2), none = update(0, 10.3);
  EXPECT_EQ(idsWith(*first, Marker::ADD), three);
  EXPECT_EQ(idsWith(*first, Marker::DELETE), Ids());
  EXPECT_EQ(idsWith(*second, Marker::ADD), one);
  EXPECT_EQ(idsWith(*second, Marker::DELETE), (Ids{{"boxes", 2}, {"texts", 2}, {"boxes", 3}, {"texts", 3}}));
  EXPECT_EQ(idsWith(*third, Marker::DELETE), Ids());
  EXPECT_EQ(idsWith(*none, Marker::DELETE).size(), 4U);
  for (const auto& array : {first, second, third, none})
    for (const Marker& marker : array->markers)
    {
      EXPECT_TRUE(marker.action == Marker::ADD || marker.action == Marker::DELETE) << marker.action;
      EXPECT_EQ(marker.header.frame_id, "lidar");
    }
}

/// Whatever order RViz takes the markers of two lists in, once it has all of them it shows the ids of the second: none
/// is wiped, and what was deleted in vain goes by its lifetime.
TEST_F(InstanceMarkersTest, OrderOfMarkersDoesNotMatterInTheEnd)
{
  const auto first = update(4, 10.0), second = update(4, 10.1);
  std::map<std::pair<std::string, int>, Marker> shown;
  const auto take = [&shown](const Marker& marker)
  {
    if (marker.action == Marker::DELETEALL)
      shown.clear();
    else if (marker.action == Marker::DELETE)
      shown.erase({marker.ns, marker.id});
    else
      shown[{marker.ns, marker.id}] = marker;
  };
  for (const auto& array : {first, second})
    for (auto marker = array->markers.rbegin(); marker != array->markers.rend(); ++marker) take(*marker);
  EXPECT_EQ(shown.size(), 8U);
}

/// RViz's status has a warning for each of these.
TEST_F(InstanceMarkersTest, GiveRVizNothingToWarnOf)
{
  update(3, 10.0);
  const auto array = update(2, 10.1);
  for (const Marker& marker : array->markers)
  {
    const auto& q = marker.pose.orientation;
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0, 1e-6);
    EXPECT_FALSE(marker.header.frame_id.empty());
    if (marker.action != Marker::ADD) continue;
    if (marker.type == Marker::CUBE)
    {
      EXPECT_EQ(marker.text, "");
      EXPECT_GT(marker.scale.x * marker.scale.y * marker.scale.z, 0.0);
    }
    else
    {
      EXPECT_EQ(marker.type, Marker::TEXT_VIEW_FACING);
      EXPECT_EQ(marker.scale.x, 0.0);
      EXPECT_EQ(marker.scale.y, 0.0);
      EXPECT_GT(marker.scale.z, 0.0);
      EXPECT_FALSE(marker.text.empty());
    }
  }
}

TEST_F(InstanceMarkersTest, BoxHasTheObjectsColourAndTheTextItsName)
{
  const auto array = update(1, 10.0);
  ASSERT_EQ(array->markers.size(), 2U);
  EXPECT_FLOAT_EQ(array->markers[0].color.r, 1.0F);
  EXPECT_FLOAT_EQ(array->markers[0].color.g, 128.0F / 255.0F);
  EXPECT_FLOAT_EQ(array->markers[0].color.b, 0.0F);
  EXPECT_EQ(array->markers[1].text, "car 1");
  EXPECT_GT(array->markers[1].pose.position.z, -1.0 + 0.75) << "above the box";
}

TEST_F(InstanceMarkersTest, LiveForThreeIntervalsButThreeSecondsAtLeast)
{
  const auto lifetime = [this](double now) { return update(1, now)->markers.at(0).lifetime.toSec(); };
  EXPECT_NEAR(lifetime(10.0), 10.0, 1e-6) << "the interval is not known yet";
  EXPECT_NEAR(lifetime(10.1), 3.0, 1e-6);
  EXPECT_NEAR(lifetime(12.1), 6.0, 1e-6);
  EXPECT_NEAR(lifetime(5.0), 10.0, 1e-6) << "a bag played again";
  EXPECT_NEAR(lifetime(5.1), 3.0, 1e-6);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
