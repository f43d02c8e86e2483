#include "ros/cloud_subscription.h"

#include "damaged_cloud.h"
#include "labelled_scene.h"

#include <gtest/gtest.h>
#include <pcl_conversions/pcl_conversions.h>
#include <ros/callback_queue.h>

#include <thread>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
sensor_msgs::PointCloud2Ptr toRos(const RawMessage& raw)
{
  return toRosMessage(raw, "lidar", ros::Time(12, 345678999));
}

/// Two points, (1, 2, 3) and (4, 5, 6), of classes 10 and 252.
RawMessage twoPoints(NumberType coordinates, NumberType label, std::uint32_t row_padding)
{
  std::uint32_t step = 0;
  const auto fields = packed({{"label", label}, {"z", coordinates}, {"y", coordinates}, {"x", coordinates}}, step);
  RawMessage raw(1, 2, fields, step, row_padding);
  raw.setPoint(0, 0, 1, 2, 3);
  raw.setPoint(0, 1, 4, 5, 6);
  raw.set(0, 0, "label", 10);
  raw.set(0, 1, "label", 252);
  return raw;
}

void expectTwoPoints(const LabelledCloud& cloud)
{
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0].x, 1.0F);
  EXPECT_EQ(cloud.points[0].z, 3.0F);
  EXPECT_EQ(cloud.points[1].y, 5.0F);
  EXPECT_EQ(cloud.points[0].label, 10U);
  EXPECT_EQ(cloud.points[1].label, 252U);
  EXPECT_EQ(cloud.header.frame_id, "lidar");
  EXPECT_EQ(cloud.header.stamp, 12345678U);
}

/// What one subscriber saw, in this thread, by its own queue.
template <class Cloud>
struct Receiver
{
  ros::CallbackQueue queue;
  std::vector<boost::shared_ptr<const Cloud>> clouds;
  std::vector<std::string> errors;
  ros::Subscriber subscriber;

  Receiver(ros::NodeHandle& nh, const std::string& topic)
  {
    const auto here = std::this_thread::get_id();
    subscriber = subscribeChecked<Cloud>(
        nh, topic, 10, [this](const boost::shared_ptr<const Cloud>& cloud) { clouds.push_back(cloud); },
        [this, here](const std::string& error)
        {
          EXPECT_EQ(std::this_thread::get_id(), here);
          errors.push_back(error);
        },
        &queue);
  }

  void wait(std::size_t results)
  {
    for (int i = 0; i < 100 && clouds.size() + errors.size() < results; ++i)
      queue.callAvailable(ros::WallDuration(0.05));
  }
};

template <class Message>
ros::Publisher advertise(ros::NodeHandle& nh, const std::string& topic, std::uint32_t subscribers = 1)
{
  const auto publisher = nh.advertise<Message>(topic, 10);
  for (int i = 0; i < 100 && publisher.getNumSubscribers() < subscribers; ++i) ros::WallDuration(0.05).sleep();
  return publisher;
}

TEST(CloudSubscription, PointCloud2OfThisProcessIsReadByItsOwnLayout)
{
  ros::NodeHandle nh;
  Receiver<LabelledCloud> receiver(nh, "layouts");
  const auto publisher = advertise<sensor_msgs::PointCloud2>(nh, "layouts");
  publisher.publish(toRos(twoPoints(NumberType::kFloat32, NumberType::kUint8, 0)));
  publisher.publish(toRos(twoPoints(NumberType::kFloat64, NumberType::kUint16, 7)));
  publisher.publish(toRos(twoPoints(NumberType::kFloat32, NumberType::kFloat32, 1)));
  receiver.wait(3);
  EXPECT_TRUE(receiver.errors.empty());
  ASSERT_EQ(receiver.clouds.size(), 3U);
  for (const auto& cloud : receiver.clouds) expectTwoPoints(*cloud);
}

TEST(CloudSubscription, PointerOfThisProcessPassesUntouched)
{
  ros::NodeHandle nh;
  Receiver<LabelledCloud> receiver(nh, "pointers");
  const auto publisher = advertise<LabelledCloud>(nh, "pointers");
  const LabelledCloud::Ptr cloud(new LabelledCloud);
  cloud->points.resize(3);  // width and height contradict: nobody looks
  publisher.publish(pcl::ros_ptr(cloud));
  receiver.wait(1);
  ASSERT_EQ(receiver.clouds.size(), 1U);
  EXPECT_EQ(receiver.clouds[0].get(), cloud.get());
}

TEST(CloudSubscription, BadCloudsAreReportedToEverySubscriberAndGoodOnesGoOn)
{
  ros::NodeHandle nh;
  const auto first = std::make_unique<Receiver<LabelledCloud>>(nh, "bad");
  Receiver<LabelledCloud> second(nh, "bad");
  const auto publisher = advertise<sensor_msgs::PointCloud2>(nh, "bad");
  auto bad = twoPoints(NumberType::kFloat32, NumberType::kUint8, 0);
  bad.header.fields[0].offset = 100;
  publisher.publish(toRos(bad));
  publisher.publish(toRos(twoPoints(NumberType::kFloat32, NumberType::kUint8, 0)));
  for (auto* receiver : {first.get(), &second})
  {
    receiver->wait(2);
    ASSERT_EQ(receiver->errors.size(), 1U);
    EXPECT_EQ(receiver->errors[0],
              "cloud on /bad from " + ros::this_node::getName() +
                  " dropped: expected field 'label' inside the point of 13 bytes, found 1 bytes at offset 100");
    ASSERT_EQ(receiver->clouds.size(), 1U);
    expectTwoPoints(*receiver->clouds[0]);
  }
}

/// roscpp reads a message with the first subscriber's helper, also when that one is gone before the second one asks.
TEST(CloudSubscription, SubscriberThatIsGoneIsNotCalled)
{
  ros::NodeHandle nh;
  auto first = std::make_unique<Receiver<LabelledCloud>>(nh, "gone");
  Receiver<LabelledCloud> second(nh, "gone");
  const auto publisher = advertise<sensor_msgs::PointCloud2>(nh, "gone");
  auto bad = twoPoints(NumberType::kFloat32, NumberType::kUint8, 0);
  bad.bytes.pop_back();
  publisher.publish(toRos(bad));
  for (int i = 0; i < 100 && second.queue.isEmpty(); ++i) ros::WallDuration(0.05).sleep();
  first.reset();
  second.wait(1);
  EXPECT_EQ(second.errors.size(), 1U);
}

/// Several subscribers of sensor_msgs/PointCloud2 share what roscpp makes of a message.
TEST(CloudSubscription, DamagedMessageIsReportedToEverySubscriberOfItsOwnType)
{
  ros::NodeHandle nh;
  Receiver<sensor_msgs::PointCloud2> first(nh, "damaged"), second(nh, "damaged");
  const auto publisher = advertise<DamagedCloud>(nh, "damaged");
  const auto good = toRos(twoPoints(NumberType::kFloat32, NumberType::kUint8, 0));
  publisher.publish(boost::make_shared<DamagedCloud>(DamagedCloud{*good}));
  const auto whole = advertise<sensor_msgs::PointCloud2>(nh, "damaged");
  whole.publish(good);
  for (auto* receiver : {&first, &second})
  {
    receiver->wait(2);
    ASSERT_EQ(receiver->errors.size(), 1U);
    EXPECT_NE(receiver->errors[0].find("expected a whole sensor_msgs/PointCloud2, found that its "), std::string::npos)
        << receiver->errors[0];
    ASSERT_EQ(receiver->clouds.size(), 1U);
    EXPECT_EQ(receiver->clouds[0].get(), good.get()) << "the way by pointer is kept";
  }
}

TEST(CloudSubscription, ArrivalTellsHowAMessageCame)
{
  ros::NodeHandle nh;
  ros::CallbackQueue queue;
  std::vector<Arrival> arrivals;
  const auto subscriber = subscribeChecked<sensor_msgs::PointCloud2>(
      nh, "arrivals", 10,
      [&](const sensor_msgs::PointCloud2ConstPtr&, const Arrival& arrival) { arrivals.push_back(arrival); },
      [](const std::string& error) { ADD_FAILURE() << error; }, &queue);
  const auto receive = [&](const ros::Publisher& publisher, auto message)
  {
    const std::size_t before = arrivals.size();
    publisher.publish(message);
    for (int i = 0; i < 100 && arrivals.size() == before; ++i) queue.callAvailable(ros::WallDuration(0.05));
    return arrivals.empty() ? Arrival() : arrivals.back();
  };
  const auto cloud = toRos(twoPoints(NumberType::kFloat32, NumberType::kUint8, 0));
  auto publisher = advertise<sensor_msgs::PointCloud2>(nh, "arrivals");
  Arrival arrival = receive(publisher, cloud);
  EXPECT_TRUE(arrival.by_pointer);
  EXPECT_FALSE(arrival.latched);
  EXPECT_EQ(arrival.sender, ros::this_node::getName());
  EXPECT_FALSE(receive(publisher, *cloud).by_pointer) << "published by reference, as most drivers do";
  publisher.shutdown();

  publisher = nh.advertise<sensor_msgs::PointCloud2>("arrivals", 1, true);
  for (int i = 0; i < 100 && publisher.getNumSubscribers() == 0; ++i) ros::WallDuration(0.05).sleep();
  arrival = receive(publisher, cloud);
  EXPECT_TRUE(arrival.latched);
}

TEST(CloudSubscription, PanopticCloudsKeepTheirIds)
{
  ros::NodeHandle nh;
  Receiver<PanopticCloud> receiver(nh, "panoptic");
  const auto publisher = advertise<sensor_msgs::PointCloud2>(nh, "panoptic");
  PanopticCloud cloud;
  cloud.header.frame_id = "lidar";
  cloud.header.stamp = 77;
  cloud.points.resize(1);
  cloud.width = cloud.height = 1;
  cloud.points[0].instance = 5;
  cloud.points[0].label = 10;
  cloud.points[0].rgb = 0x00ABCDEF;
  const auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  pcl::toROSMsg(cloud, *message);
  publisher.publish(message);
  publisher.publish(toRos(twoPoints(NumberType::kFloat32, NumberType::kUint8, 0)));
  receiver.wait(2);
  ASSERT_EQ(receiver.clouds.size(), 1U);
  EXPECT_EQ(receiver.clouds[0]->points[0].instance, 5U);
  EXPECT_EQ(receiver.clouds[0]->points[0].label, 10U);
  EXPECT_EQ(receiver.clouds[0]->points[0].rgb, 0x00ABCDEFU);
  EXPECT_EQ(receiver.clouds[0]->header.stamp, 77U);
  ASSERT_EQ(receiver.errors.size(), 1U);
  EXPECT_NE(receiver.errors[0].find("expected a field 'instance'"), std::string::npos) << receiver.errors[0];
}

template <class Message>
std::vector<std::uint8_t> serialized(const Message& message)
{
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/// Read again it is the same; each part of it is refused.
template <class Message>
void expectReadWholeOnly(const Message& message)
{
  const std::vector<std::uint8_t> bytes = serialized(message);
  for (std::uint32_t size = 0; size < bytes.size(); ++size)
  {
    std::vector<std::uint8_t> part(bytes.begin(), bytes.begin() + size);
    Message read;
    EXPECT_THROW(readSerialized(part.data(), size, read), std::runtime_error) << size;
  }
  std::vector<std::uint8_t> whole = bytes;
  Message read;
  readSerialized(whole.data(), static_cast<std::uint32_t>(whole.size()), read);
  EXPECT_EQ(serialized(read), bytes);
}

TEST(ReadSerialized, MessagesThatStayWhatTheyAreAreReadWholeOrNotAtAll)
{
  auto cloud = *toRos(twoPoints(NumberType::kFloat64, NumberType::kUint16, 3));
  cloud.is_dense = 1;
  expectReadWholeOnly(cloud);

  sensor_msgs::Image image;
  image.header.frame_id = "camera";
  image.height = 2, image.width = 3, image.step = 3;
  image.encoding = "mono8";
  image.data = {1, 2, 3, 4, 5, 6};
  expectReadWholeOnly(image);

  diagnostic_msgs::DiagnosticArray diagnostics;
  diagnostics.header.stamp = ros::Time(1.5);
  diagnostics.status.resize(2);
  diagnostics.status[1].name = "nodelet";
  diagnostics.status[1].values.resize(1);
  diagnostics.status[1].values[0].key = "things";
  expectReadWholeOnly(diagnostics);
}

TEST(ReadSerialized, TruncatedMessagesAreRefused)
{
  const auto message = toRos(twoPoints(NumberType::kFloat32, NumberType::kUint8, 0));
  std::vector<std::uint8_t> bytes = serialized(*message);
  LabelledCloud cloud;
  readSerialized(bytes.data(), static_cast<std::uint32_t>(bytes.size()), cloud);
  expectTwoPoints(cloud);
  for (std::uint32_t size = 0; size + 1 < bytes.size(); ++size)  // the last byte, is_dense, is not read
  {
    std::vector<std::uint8_t> part(bytes.begin(), bytes.begin() + size);
    EXPECT_THROW(readSerialized(part.data(), size, cloud), std::runtime_error) << size;
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "cloud_subscription_test");
  ros::NodeHandle keeps_the_node_up;
  return RUN_ALL_TESTS();
}
