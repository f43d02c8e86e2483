#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>

/// A nodelet manager as `nodelet manager` is, that ends cleanly: nodelets are loaded into it by `nodelet load`.
///
/// The stock one reads freed memory where Ctrl-C ends it and those who loaded nodelets together: nodelet::Loader first
/// frees its queues, then its bonds, and a bond that breaks unloads a nodelet, whose queue is to be taken from them. It
/// segfaults, aborts with boost::lock_error, or traps at a bond that was made while ROS ended.
int main(int argc, char** argv)
{
  ros::init(argc, argv, "manager");
  auto* loader = new nodelet::Loader;  // never freed
  ros::spin();
  loader->clear();
  ros::shutdown();
  std::fflush(nullptr);
  std::quick_exit(EXIT_SUCCESS);
}
