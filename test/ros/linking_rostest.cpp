// Publishers and subscribers of one process that start at the same time are linked once.
#include "organizer_fixture.h"
#include "ros/linking.h"

#include <std_msgs/Empty.h>

#include <thread>

namespace lidar_panoptic_clustering
{
namespace
{
/// Links of this process to a topic that it publishes itself.
std::size_t linksOf(const std::string& topic)
{
  return ros::TopicManager::instance()->getNumSubscribers(topic);
}

/// Publisher and subscriber of each topic are made by two threads that start each pair at once.
TEST(Linking, OneThreadAdvertisesWhileAnotherSubscribes)
{
  constexpr int kPairs = 150;
  ros::NodeHandle nh;
  std::vector<ros::Publisher> publishers(kPairs);
  std::vector<ros::Subscriber> subscribers(kPairs);
  const auto topic = [](int i) { return "/linking/topic_" + std::to_string(i); };
  std::atomic<int> ready{0};
  const auto atOnce = [&](auto make)
  {
    for (int i = 0; i < kPairs; ++i)
    {
      ++ready;
      while (ready < 2 * (i + 1)) std::this_thread::yield();
      make(i);
    }
  };
  std::thread advertising(
      [&] { atOnce([&](int i) { publishers[i] = advertiseAlone<std_msgs::Empty>(nh, topic(i), 1); }); });
  atOnce(
      [&](int i)
      {
        ros::SubscribeOptions options;
        options.init<std_msgs::Empty>(topic(i), 1, [](const boost::shared_ptr<const std_msgs::Empty>&) {});
        subscribers[i] = subscribeAlone(nh, options);
      });
  advertising.join();
  for (int i = 0; i < kPairs; ++i)
  {
    EXPECT_TRUE(eventually([&] { return linksOf(topic(i)) > 0; })) << topic(i);
    EXPECT_EQ(linksOf(topic(i)), 1U) << topic(i);
  }
}

class StartWhileSomeoneListens : public Graph
{
};

/// As RViz left open: the nodelets are loaded by two threads, as two `nodelet load` have a manager do it, and subscribe
/// at once.
TEST_F(StartWhileSomeoneListens, OrganizerAndClusterNodeletAreLinkedOnce)
{
  nodelet::Loader second_loader{false};
  for (int round = 0; round < 20; ++round)
  {
    const std::string name = newName(), organizer = name + "_organizer";
    Probe<PanopticCloud> output(name + "/output");
    Probe<sensor_msgs::PointCloud2> original(name + "/output_original");
    std::thread load_organizer(
        [&]
        {
          EXPECT_TRUE(second_loader.load(organizer, "lidar_panoptic_clustering/OrganizerNodelet",
                                         {{organizer + "/panoptic", name + "/output"},
                                          {organizer + "/output_original", name + "/output_original"}},
                                         {}));
        });
    EXPECT_TRUE(tryLoad(name, "BirdsEyeClusterNodelet", {{name + "/input", organizer + "/output"}}));
    load_organizer.join();
    EXPECT_TRUE(eventually([&] { return linksOf(organizer + "/output") > 0; }));
    // the probe and the organizer share the process's one link
    EXPECT_TRUE(eventually([&] { return linksOf(name + "/output") > 0; }));
    ros::WallDuration(0.1).sleep();
    EXPECT_EQ(linksOf(organizer + "/output"), 1U) << round;
    EXPECT_EQ(linksOf(name + "/output"), 1U) << round;
    EXPECT_TRUE(loader_.unload(name));
    EXPECT_TRUE(second_loader.unload(organizer));
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "linking_test");
}
