#pragma once

// Included first by the headers that all others include: without it a package that compiles with an older standard,
// which is gcc 10's and catkin's default, sees forty lines about std::variant.
#if __cplusplus < 201703L
#error "lidar_panoptic_clustering needs C++17: add set(CMAKE_CXX_STANDARD 17) before your targets in CMakeLists.txt"
#endif
