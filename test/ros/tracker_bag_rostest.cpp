#include "graph_fixture.h"
#include "tracked_scene.h"

#include <lidar_panoptic_clustering/ObjectArray.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>

#include <cstdlib>
#include <set>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr int kScans = 20;

/// The street's scans and transforms, ten a second.
void writeBag(const std::string& path)
{
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  for (int i = 0; i < kScans; ++i)
  {
    const double seconds = 0.1 * i;
    bag.write("/tf", kStart + ros::Duration(seconds), streetTransform(seconds));
    sensor_msgs::PointCloud2 cloud;
    pcl::toROSMsg(*streetScan(seconds, i % 2 == 0 ? 1 : 2, i % 2 == 0 ? 2 : 1), cloud);
    bag.write("/clustered", kStart + ros::Duration(seconds + 0.01), cloud);
  }
}

/// The messages that gencpp 0.6.2 makes have no operator==.
std::string bytesOf(const Object& object)
{
  const ros::SerializedMessage message = ros::serialization::serializeMessage(object);
  return {reinterpret_cast<const char*>(message.buf.get()), message.num_bytes};
}

class TrackerBag : public Graph
{
};

/// --clock sets time back with the second run: the tracks start anew, with new ids, and everything else is the same.
TEST_F(TrackerBag, PlayedTwiceGivesEqualResults)
{
  const std::string path = "/tmp/lidar_panoptic_tracker_" + std::to_string(getpid()) + ".bag";
  writeBag(path);
  const std::string name = newName();
  ASSERT_TRUE(tryLoad(name, "TrackerNodelet", {{name + "/input", "/clustered"}}));
  Probe<ObjectArray> objects(name + "/objects");
  ASSERT_TRUE(eventually([&] { return objects.subscriber().getNumPublishers() > 0; }));
  std::vector<ObjectArrayConstPtr> runs[2];
  for (auto& lists : runs)
  {
    ASSERT_EQ(std::system(("rosbag play --quiet --clock --delay=1.0 " + path + " > /dev/null").c_str()), 0);
    eventually(
        [&]
        {
          while (const auto list = objects.takeIfThere()) lists.push_back(list);
          return lists.size() == kScans;
        });
    ASSERT_EQ(lists.size(), static_cast<std::size_t>(kScans));
  }
  std::filesystem::remove(path);

  std::set<std::uint32_t> first_ids, second_ids;
  for (int i = 0; i < kScans; ++i)
  {
    const ObjectArray &first = *runs[0][i], &second = *runs[1][i];
    EXPECT_EQ(first.header.stamp, second.header.stamp);
    ASSERT_EQ(first.objects.size(), 2U) << i;
    ASSERT_EQ(second.objects.size(), 2U) << i;
    EXPECT_EQ(first.fixed_frame, "odom") << i;
    for (int k = 0; k < 2; ++k)
    {
      Object a = first.objects[k], b = second.objects[k];
      first_ids.insert(a.track_id), second_ids.insert(b.track_id);
      a.track_id = b.track_id = 0;
      EXPECT_TRUE(bytesOf(a) == bytesOf(b)) << "scan " << i << "\n" << a << "\n" << b;
    }
  }
  EXPECT_EQ(first_ids.size(), 2U);
  EXPECT_EQ(second_ids.size(), 2U);
  EXPECT_GT(*second_ids.begin(), *first_ids.rbegin()) << "no id is given twice";
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "tracker_bag_test");
}
