#include "ros/cluster_nodelet.h"

#include <lidar_panoptic_clustering/EuclideanClusterConfig.h>
#include <pluginlib/class_list_macros.hpp>

namespace lidar_panoptic_clustering
{
class EuclideanClusterNodelet : public TunableClusterNodelet<EuclideanClusterConfig>
{
public:
  EuclideanClusterNodelet() : TunableClusterNodelet("euclidean") {}
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::EuclideanClusterNodelet, nodelet::Nodelet)
