#include "ros/unlabelled_outputs.h"

#include "ros/linking.h"

#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kFloatBytes = sizeof(float);

/// One float a pixel.
template <class Value>
sensor_msgs::ImagePtr imageOf(const std_msgs::Header& header, const LabelledCloud& cloud, Value value)
{
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = header;
  image->width = cloud.width, image->height = cloud.height;
  image->encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  image->step = cloud.width * kFloatBytes;
  image->data.resize(cloud.points.size() * kFloatBytes);
  std::uint8_t* to = image->data.data();
  for (const LabelledPoint& point : cloud.points)
  {
    const float number = value(point);
    std::memcpy(to, &number, kFloatBytes);
    to += kFloatBytes;
  }
  return image;
}
}  // namespace

sensor_msgs::PointCloud2Ptr unlabelledCloud(const std_msgs::Header& header, const LabelledCloud& cloud)
{
  const auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  message->header = header;
  message->width = cloud.width, message->height = cloud.height;
  for (const char* name : {"x", "y", "z", "intensity"})
  {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(message->fields.size()) * kFloatBytes;
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    message->fields.push_back(field);
  }
  message->point_step = 4 * kFloatBytes;
  message->row_step = message->width * message->point_step;
  message->data.resize(cloud.points.size() * message->point_step);
  std::uint8_t* to = message->data.data();
  for (const LabelledPoint& point : cloud.points)
  {
    const float numbers[] = {point.x, point.y, point.z, point.intensity};
    std::memcpy(to, numbers, sizeof(numbers));
    to += sizeof(numbers);
  }
  return message;
}

sensor_msgs::ImagePtr rangeImage(const std_msgs::Header& header, const LabelledCloud& cloud)
{
  return imageOf(header, cloud, [](const LabelledPoint& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); });
}

sensor_msgs::ImagePtr intensityImage(const std_msgs::Header& header, const LabelledCloud& cloud)
{
  return imageOf(header, cloud, [](const LabelledPoint& p) { return p.intensity; });
}

void UnlabelledOutputs::advertise(ros::NodeHandle& nh, const ros::SubscriberStatusCallback& status)
{
  cloud_ = advertiseAlone<sensor_msgs::PointCloud2>(nh, "unlabelled", 1, status, status);
  range_ = advertiseAlone<sensor_msgs::Image>(nh, "range", 1, status, status);
  intensity_ = advertiseAlone<sensor_msgs::Image>(nh, "intensity", 1, status, status);
}

void UnlabelledOutputs::shutdown()
{
  cloud_.shutdown();
  range_.shutdown();
  intensity_.shutdown();
}

bool UnlabelledOutputs::wanted() const
{
  return cloud_.getNumSubscribers() > 0 || range_.getNumSubscribers() > 0 || intensity_.getNumSubscribers() > 0;
}

void UnlabelledOutputs::publish(const std_msgs::Header& header, const LabelledCloud& cloud) const
{
  if (cloud_.getNumSubscribers() > 0) cloud_.publish(unlabelledCloud(header, cloud));
  if (range_.getNumSubscribers() > 0) range_.publish(rangeImage(header, cloud));
  if (intensity_.getNumSubscribers() > 0) intensity_.publish(intensityImage(header, cloud));
}
}  // namespace lidar_panoptic_clustering
