# What find_package(lidar_panoptic_clustering) reads: defines the target
# lidar_panoptic_clustering::lidar_panoptic_clustering, the library without ROS.
include(CMakeFindDependencyMacro)
find_dependency(PCL COMPONENTS common search segmentation)
if(NOT TARGET lidar_panoptic_clustering::lidar_panoptic_clustering AND NOT TARGET lidar_panoptic_clustering)
  include(${CMAKE_CURRENT_LIST_DIR}/lidar_panoptic_clusteringTargets.cmake)
endif()
