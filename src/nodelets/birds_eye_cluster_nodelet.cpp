#include "ros/cluster_nodelet.h"

#include <lidar_panoptic_clustering/BirdsEyeClusterConfig.h>
#include <pluginlib/class_list_macros.hpp>

namespace lidar_panoptic_clustering
{
class BirdsEyeClusterNodelet : public TunableClusterNodelet<BirdsEyeClusterConfig>
{
public:
  BirdsEyeClusterNodelet() : TunableClusterNodelet("birds_eye") {}
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::BirdsEyeClusterNodelet, nodelet::Nodelet)
