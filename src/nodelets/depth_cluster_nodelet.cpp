#include "ros/cluster_nodelet.h"

#include <lidar_panoptic_clustering/DepthClusterConfig.h>
#include <pluginlib/class_list_macros.hpp>

namespace lidar_panoptic_clustering
{
class DepthClusterNodelet : public TunableClusterNodelet<DepthClusterConfig>
{
public:
  DepthClusterNodelet() : TunableClusterNodelet("depth") {}
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::DepthClusterNodelet, nodelet::Nodelet)
