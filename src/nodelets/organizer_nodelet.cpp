#include "ros/organizer_nodelet.h"

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::OrganizerNodelet, nodelet::Nodelet)
