#include "ros/object_list.h"

#include <boost/make_shared.hpp>

#include <cmath>

namespace lidar_panoptic_clustering
{
double rounded(double value, double steps)
{
  return std::round(value * steps) / steps + 0.0;  // no -0
}

void setClass(const ClassTable& table, ClassIndex class_index, Object& object)
{
  const ClassInfo& info = table[class_index];
  object.class_id = info.ids.empty() ? 0 : info.ids.front();
  object.class_name = info.name;
}

void setBox(const InstanceBox& box, Object& object)
{
  object.pose.position.x = rounded(box.x);
  object.pose.position.y = rounded(box.y);
  object.pose.position.z = rounded(box.z);
  object.pose.orientation.z = rounded(std::sin(0.5 * box.yaw), 1e6);
  object.pose.orientation.w = rounded(std::cos(0.5 * box.yaw), 1e6);
  object.size.x = rounded(box.length);
  object.size.y = rounded(box.width);
  object.size.z = rounded(box.height);
}

ObjectArrayPtr listObjects(const std_msgs::Header& header, const ClassTable& table, const ThingScan& things,
                           const Instances& instances, const std::vector<InstanceBox>& boxes)
{
  const auto list = boost::make_shared<ObjectArray>();
  list->header = header;
  list->class_table = table.name();
  list->objects.resize(instances.count());
  for (std::size_t i = 0; i < things.size(); ++i)
  {
    const std::uint32_t id = instances.id[i];
    if (id != 0 && instances.objects[id - 1].class_index == things.class_index[i])
      list->objects[id - 1].class_share += 1.0;
  }
  for (std::size_t k = 0; k < instances.count(); ++k)
  {
    const Instances::Object& instance = instances.objects[k];
    Object& object = list->objects[k];
    object.instance_id = static_cast<std::uint32_t>(k + 1);
    setClass(table, instance.class_index, object);
    object.points = instance.point_count;
    object.class_share = rounded(object.class_share / instance.point_count);
    setBox(boxes[k], object);
  }
  return list;
}
}  // namespace lidar_panoptic_clustering
