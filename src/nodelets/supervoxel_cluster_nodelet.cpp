#include "ros/cluster_nodelet.h"

#include <lidar_panoptic_clustering/SupervoxelClusterConfig.h>
#include <pluginlib/class_list_macros.hpp>

namespace lidar_panoptic_clustering
{
class SupervoxelClusterNodelet : public TunableClusterNodelet<SupervoxelClusterConfig>
{
public:
  SupervoxelClusterNodelet() : TunableClusterNodelet("supervoxel") {}
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::SupervoxelClusterNodelet, nodelet::Nodelet)
