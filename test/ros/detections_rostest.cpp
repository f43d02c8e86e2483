#include "graph_fixture.h"
#include "labelled_scene.h"
#include "tracked_scene.h"

#include <lidar_panoptic_clustering/ObjectArray.h>
#ifdef LIDAR_PANOPTIC_VISION_MSGS
#include <vision_msgs/Detection3DArray.h>
#endif

namespace lidar_panoptic_clustering
{
namespace
{
class Detections : public Graph
{
};

#ifdef LIDAR_PANOPTIC_VISION_MSGS
using vision_msgs::Detection3DArray;

/// What a detection can hold of an object.
void expectSame(const vision_msgs::Detection3D& detection, const Object& object, const std_msgs::Header& header)
{
  EXPECT_EQ(detection.header.frame_id, header.frame_id);
  EXPECT_EQ(detection.header.stamp, header.stamp);
  EXPECT_EQ(detection.bbox.center, object.pose);
  EXPECT_EQ(detection.bbox.size, object.size);
  ASSERT_EQ(detection.results.size(), 1U);
  const auto& hypothesis = detection.results.front();
  EXPECT_EQ(hypothesis.id, object.class_id);
  EXPECT_EQ(hypothesis.score, object.class_share);
  EXPECT_EQ(hypothesis.pose.pose, object.pose);
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 6; ++column)
    {
      const bool is_position = row < 3 && column < 3;
      EXPECT_EQ(hypothesis.pose.covariance[6 * row + column],
                is_position ? object.position_covariance[3 * row + column] : 0.0)
          << row << ' ' << column;
    }
}

TEST_F(Detections, OfAClusterNodeletAreItsObjectList)
{
  const std::string name = load("EuclideanClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  EXPECT_EQ(input.getNumSubscribers(), 0U) << "nobody listens";
  Probe<Detection3DArray> detections(name + "/detections"), again(name + "/detections");
  waitForSubscriber(input);
  Probe<ObjectArray> objects(name + "/objects");
  for (const ros::Subscriber& subscriber : {detections.subscriber(), again.subscriber(), objects.subscriber()})
    ASSERT_TRUE(eventually([&] { return subscriber.getNumPublishers() > 0; }));
  input.publish(share(labelledScene()));
  const auto list = objects.next();
  const auto array = detections.next();
  ASSERT_TRUE(list && array);
  EXPECT_EQ(again.next().get(), array.get()) << "by pointer";
  EXPECT_EQ(array->header.frame_id, "lidar");
  EXPECT_EQ(array->header.stamp, list->header.stamp);
  ASSERT_GT(list->objects.size(), 3U);
  ASSERT_EQ(array->detections.size(), list->objects.size());
  for (std::size_t k = 0; k < list->objects.size(); ++k)
    expectSame(array->detections[k], list->objects[k], list->header);
}

TEST_F(Detections, OfATrackerAreTheObjectsThatAreSeen)
{
  const std::string name = newName();
  ros::param::set(name + "/fixed_frame", "");
  ASSERT_TRUE(tryLoad(name, "TrackerNodelet"));
  const auto input = advertise<PanopticCloud>(name + "/input");
  Probe<Detection3DArray> detections(name + "/detections");
  Probe<ObjectArray> objects(name + "/objects");
  waitForSubscriber(input);
  for (const ros::Subscriber& subscriber : {detections.subscriber(), objects.subscriber()})
    ASSERT_TRUE(eventually([&] { return subscriber.getNumPublishers() > 0; }));
  for (int i = 0; i < 6; ++i)
  {
    const auto cloud = streetScan(0.1 * i, 1, 2);
    const bool is_hidden = i == 5;
    if (is_hidden)
      for (auto& point : cloud->points)
        if (point.instance == 2) point.instance = 0;
    input.publish(boost::shared_ptr<const PanopticCloud>(cloud));
    const auto list = objects.next();
    const auto array = detections.next();
    ASSERT_TRUE(list && array);
    ASSERT_EQ(list->objects.size(), 2U) << "one that is hidden is listed";
    ASSERT_EQ(array->detections.size(), is_hidden ? 1U : 2U) << "and is no detection";
    for (std::size_t k = 0; k < array->detections.size(); ++k)
    {
      expectSame(array->detections[k], list->objects[k], list->header);
      EXPECT_GT(array->detections[k].results.front().pose.covariance[0], 0.0);
    }
  }
}
#else
TEST_F(Detections, AreNotAdvertisedWithoutVisionMsgs)
{
  const std::string name = load("EuclideanClusterNodelet");
  const auto input = advertise<LabelledCloud>(name + "/input");
  Probe<ObjectArray> objects(name + "/objects");
  waitForSubscriber(input);
  ros::master::V_TopicInfo topics;
  ASSERT_TRUE(ros::master::getTopics(topics));
  for (const auto& topic : topics) EXPECT_NE(topic.name, name + "/detections");
  GTEST_SKIP() << "vision_msgs was not there when this was built: its messages are not tested";
}
#endif
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "detections_test");
}
