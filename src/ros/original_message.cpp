#include "ros/original_message.h"

namespace lidar_panoptic_clustering
{
sensor_msgs::PointCloud2Ptr toMessage(OriginalCloud& cloud, const sensor_msgs::PointCloud2& sent)
{
  const auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  message->header = sent.header;
  message->width = sent.width, message->height = sent.height;
  message->is_bigendian = sent.is_bigendian, message->is_dense = sent.is_dense;
  message->fields.resize(cloud.fields.size());
  for (std::size_t i = 0; i < cloud.fields.size(); ++i)
  {
    message->fields[i].name = cloud.fields[i].name;
    message->fields[i].offset = cloud.fields[i].offset;
    message->fields[i].datatype = cloud.fields[i].datatype;
    message->fields[i].count = cloud.fields[i].count;
  }
  message->point_step = cloud.point_step, message->row_step = cloud.row_step;
  message->data.swap(cloud.data);
  return message;
}
}  // namespace lidar_panoptic_clustering
