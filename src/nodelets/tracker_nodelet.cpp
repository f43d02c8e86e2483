#include "ros/tracker_nodelet.h"

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::TrackerNodelet, nodelet::Nodelet)
