# What find_package(lidar_panoptic_clustering) reads: defines the target
# lidar_panoptic_clustering::lidar_panoptic_clustering, the library without ROS.
include(CMakeFindDependencyMacro)
find_dependency(PCL COMPONENTS common search segmentation)
if(NOT TARGET lidar_panoptic_clustering::lidar_panoptic_clustering AND NOT TARGET lidar_panoptic_clustering)
  # beside the configuration that includes this; in a devel space this file itself stays in the source
  include(${lidar_panoptic_clustering_DIR}/lidar_panoptic_clusteringTargets.cmake)
endif()
