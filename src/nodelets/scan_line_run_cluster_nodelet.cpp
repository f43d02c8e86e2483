#include "ros/cluster_nodelet.h"

#include <lidar_panoptic_clustering/ScanLineRunClusterConfig.h>
#include <pluginlib/class_list_macros.hpp>

namespace lidar_panoptic_clustering
{
class ScanLineRunClusterNodelet : public TunableClusterNodelet<ScanLineRunClusterConfig>
{
public:
  ScanLineRunClusterNodelet() : TunableClusterNodelet("scan_line_run") {}
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::ScanLineRunClusterNodelet, nodelet::Nodelet)
