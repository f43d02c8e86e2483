#include "graph_fixture.h"
#include "labelled_scene.h"

#include <lidar_panoptic_clustering/ObjectArray.h>
#include <pcl_ros/point_cloud.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>

namespace lidar_panoptic_clustering
{
namespace
{
class EachClusterNodelet : public Graph, public testing::WithParamInterface<std::pair<std::string, std::string>>
{
};
INSTANTIATE_TEST_SUITE_P(Algorithms, EachClusterNodelet, testing::ValuesIn(clusterNodelets()),
                         [](const auto& instance) { return instance.param.first; });

TEST_P(EachClusterNodelet, ListsTheObjectsOfItsCloud)
{
  const std::string name = load(GetParam().second);
  const auto input = advertise<LabelledCloud>(name + "/input");
  EXPECT_EQ(input.getNumSubscribers(), 0U) << "nobody listens";
  Probe<ObjectArray> objects(name + "/objects"), again(name + "/objects");
  Probe<PanopticCloud> output(name + "/output");
  Probe<visualization_msgs::MarkerArray> markers(name + "/markers");
  waitForSubscriber(input);
  for (const ros::Subscriber& subscriber :
       {objects.subscriber(), again.subscriber(), output.subscriber(), markers.subscriber()})
    ASSERT_TRUE(eventually([&] { return subscriber.getNumPublishers() > 0; }));
  input.publish(share(labelledScene()));
  const auto list = objects.next();
  const auto cloud = output.next();
  const auto array = markers.next();
  ASSERT_TRUE(list && cloud && array);
  EXPECT_EQ(again.next().get(), list.get()) << "by pointer";
  EXPECT_EQ(list->header.frame_id, "lidar");
  EXPECT_EQ(list->header.stamp, ros::Time(1700000000, 123456000));
  EXPECT_EQ(list->class_table, "semantic_kitti");
  EXPECT_EQ(list->fixed_frame, "");

  std::map<std::uint32_t, std::uint32_t> points;
  for (const auto& point : cloud->points)
    if (point.instance > 0) ++points[point.instance];
  ASSERT_EQ(list->objects.size(), points.size());
  ASSERT_GT(points.size(), 3U);
  for (std::size_t k = 0; k < list->objects.size(); ++k)
  {
    const Object& object = list->objects[k];
    EXPECT_EQ(object.track_id, 0U);
    EXPECT_EQ(object.instance_id, k + 1);
    EXPECT_EQ(object.points, points.at(object.instance_id));
    EXPECT_GT(object.class_share, 0.0);
    EXPECT_LE(object.class_share, 1.0);
    EXPECT_GE(object.size.x, object.size.y);
    EXPECT_EQ(object.velocity_covariance, Object::_velocity_covariance_type()) << "not known";
    const auto& info = (*kittiTable())[kittiTable()->find(object.class_id)];
    EXPECT_EQ(info.name, object.class_name);
    EXPECT_EQ(info.ids.front(), object.class_id);
    const auto& box = array->markers[2 * k];
    EXPECT_EQ(box.pose.position.x, object.pose.position.x) << "the markers are the same list";
    EXPECT_EQ(box.id, static_cast<int>(object.instance_id));
  }
}

class ObjectList : public Graph
{
};

/// Ten points, seven of them a car's and three a truck's, on a line; the vote makes it a car.
TEST_F(ObjectList, TellsHowManyPointsAgreeOnTheClass)
{
  const std::string name = newName();
  ros::param::set(name + "/class_policy", "group");
  ASSERT_TRUE(tryLoad(name, "EuclideanClusterNodelet"));
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<ObjectArray> objects(name + "/objects");
  waitForSubscriber(input);
  LabelledCloud cloud = emptyCloud(2, 64);
  cloud.header.frame_id = "lidar";
  for (std::uint32_t i = 0; i < 10; ++i)
    cloud.points[i] = labelled(10.0F, 0.2F * static_cast<float>(i), 0.5F, i % 3 == 1 ? 18 : kCar);
  input.publish(share(cloud));
  const auto list = objects.next();
  ASSERT_TRUE(list);
  ASSERT_EQ(list->objects.size(), 1U);
  EXPECT_EQ(list->objects[0].class_name, "car");
  EXPECT_EQ(list->objects[0].points, 10U);
  EXPECT_EQ(list->objects[0].class_share, 0.7);
  EXPECT_NEAR(list->objects[0].size.x, 1.8, 1e-3);
}

TEST_F(ObjectList, GoesByAnyClassTable)
{
  const std::string name = newName();
  ros::param::set(name + "/class_table", "object");
  ASSERT_TRUE(tryLoad(name, "BirdsEyeClusterNodelet"));
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<ObjectArray> objects(name + "/objects");
  waitForSubscriber(input);
  const ClassTable table = ClassTable::load("object");
  const ClassInfo& thing = table[table.findByName("object")];
  LabelledCloud cloud = twoCars(5.0F);
  for (auto& point : cloud.points)
    if (point.label == kCar) point.label = thing.ids.front();
  input.publish(share(cloud));
  const auto list = objects.next();
  ASSERT_TRUE(list);
  ASSERT_EQ(list->objects.size(), 2U);
  EXPECT_EQ(list->class_table, "object");
  EXPECT_EQ(list->objects[0].class_name, "object");
  EXPECT_EQ(list->objects[0].class_id, thing.ids.front());
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "object_list_test");
}
