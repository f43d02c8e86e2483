#pragma once

#include "graph_fixture.h"
#include "labelled_scene.h"
#include "ros/cloud_subscription.h"
#include "unordered_clouds.h"

#include <pcl_ros/point_cloud.h>
#include <ros/topic_manager.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
inline const ros::Time kSceneStamp(1700000000, 123456000);

/// Waits until somebody listens to a topic that a nodelet of this process publishes.
inline void waitForListener(const std::string& topic)
{
  EXPECT_TRUE(eventually([&] { return ros::TopicManager::instance()->getNumSubscribers(topic) > 0; })) << topic;
}

/// An organizer between publishers and probes of the test.
class OrganizerGraph : public Graph
{
protected:
  template <class T>
  void set(const std::string& parameter, const T& value) const
  {
    ros::param::set(name_ + "/" + parameter, value);
  }

  /// Loads it after its input is advertised, and listens.
  void start(const std::string& labels = "field")
  {
    set("labels", labels);
    input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
    if (labels == "image") labels_ = advertise<sensor_msgs::Image>(name_ + "/label_input");
    if (labels == "cloud") labels_ = advertise<sensor_msgs::PointCloud2>(name_ + "/label_input");
    diagnostics_ = std::make_unique<DiagnosticsProbe>(name_);
    ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet"));
    output_ = std::make_unique<Probe<LabelledCloud>>(name_ + "/output");
    waitForSubscriber(input_);
    if (labels_) waitForSubscriber(labels_);
  }

  /// The parameter is one the nodelet must refuse to load with, and say so.
  void expectNotLoaded(const std::string& reason)
  {
    LogProbe log;
    EXPECT_FALSE(tryLoad(name_, "OrganizerNodelet"));
    const std::string message = log.waitFor("not loaded");
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  }

  const std::string name_ = newName();
  ros::Publisher input_, labels_;
  std::unique_ptr<DiagnosticsProbe> diagnostics_;
  std::unique_ptr<Probe<LabelledCloud>> output_;
};

/// The pixels of `scene` in the organizer's cloud: same coordinates, NaN for what is no return, and at the returns the
/// same labels.
inline void expectScene(const LabelledCloud& cloud, const LabelledCloud& scene = labelledScene())
{
  ASSERT_EQ(cloud.width, scene.width);
  ASSERT_EQ(cloud.height, scene.height);
  EXPECT_EQ(cloud.header.frame_id, scene.header.frame_id);
  for (std::size_t i = 0; i < scene.points.size(); ++i)
  {
    const auto &found = cloud.points[i], &sent = scene.points[i];
    ASSERT_EQ(std::isnan(found.x), !hasReturn(sent)) << i;
    if (!hasReturn(sent)) continue;
    ASSERT_EQ(found.label, sent.label) << i;
    ASSERT_EQ(found.x, sent.x) << i;
    ASSERT_EQ(found.y, sent.y) << i;
    ASSERT_EQ(found.z, sent.z) << i;
  }
}

/// The scene as a driver sends it that knows no classes: x, y, z, ring.
inline RawMessage withoutLabels(const LabelledCloud& cloud)
{
  std::uint32_t step = 0;
  auto fields = packed({{"x", NumberType::kFloat32},
                        {"y", NumberType::kFloat32},
                        {"z", NumberType::kFloat32},
                        {"ring", NumberType::kUint16}},
                       step);
  RawMessage raw(cloud.height, cloud.width, std::move(fields), step);
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < cloud.width; ++column)
    {
      const LabelledPoint& p = cloud.points[row * cloud.width + column];
      raw.setPoint(row, column, p.x, p.y, p.z);
      raw.set(row, column, "ring", row);
    }
  return raw;
}

/// The scene's classes as a network's picture.
template <class Id>
sensor_msgs::ImagePtr labelImage(const LabelledCloud& cloud, const std::string& encoding, ros::Time stamp = kSceneStamp)
{
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.stamp = stamp;
  image->height = cloud.height, image->width = cloud.width;
  image->encoding = encoding;
  image->step = static_cast<std::uint32_t>(cloud.width * sizeof(Id)) + 3;  // rows may be padded
  image->data.assign(std::size_t{image->height} * image->step, 0xAB);
  for (std::uint32_t row = 0; row < cloud.height; ++row)
    for (std::uint32_t column = 0; column < cloud.width; ++column)
    {
      const Id id = static_cast<Id>(cloud.points[row * cloud.width + column].label);
      std::memcpy(&image->data[row * image->step + column * sizeof(Id)], &id, sizeof(Id));
    }
  return image;
}

inline sensor_msgs::ImagePtr labelImage(const LabelledCloud& cloud, ros::Time stamp = kSceneStamp)
{
  return labelImage<std::uint8_t>(cloud, sensor_msgs::image_encodings::MONO8, stamp);
}

/// A field of a message by the points' row-major index.
inline std::vector<std::uint32_t> idsIn(const sensor_msgs::PointCloud2& message, const std::string& name)
{
  const RawCloud cloud = viewOf(message);
  const RawField* field = findField(cloud, name);
  EXPECT_NE(field, nullptr) << name << " in " << describeFields(cloud);
  std::vector<std::uint32_t> ids(std::size_t{message.width} * message.height);
  for (std::size_t row = 0; row < message.height && field != nullptr; ++row)
    readIds({cloud.point(row, 0), cloud.point_step, cloud.width}, *field, &ids[row * cloud.width],
            sizeof(std::uint32_t));
  return ids;
}
}  // namespace lidar_panoptic_clustering
