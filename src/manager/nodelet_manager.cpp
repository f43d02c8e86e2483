#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace
{
/// Loads a nodelet that has this process's name and remappings.
bool loadAlone(nodelet::Loader& loader, const std::string& type)
{
  try
  {
    if (loader.load(ros::this_node::getName(), type, ros::names::getRemappings(), {})) return true;
    ROS_FATAL("no nodelet %s could be loaded", type.c_str());
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("no nodelet %s could be loaded: %s", type.c_str(), error.what());
  }
  return false;
}
}  // namespace

/// A nodelet manager as `nodelet manager` is, that ends cleanly: nodelets are loaded into it by `nodelet load`. With
/// the arguments `standalone PACKAGE/TYPE` it has one from the start, as `nodelet standalone` has.
///
/// The stock one reads freed memory where Ctrl-C ends it and those who loaded nodelets together: nodelet::Loader first
/// frees its queues, then its bonds, and a bond that breaks unloads a nodelet, whose queue is to be taken from them. It
/// segfaults, aborts with boost::lock_error, or traps at a bond that was made while ROS ended.
int main(int argc, char** argv)
{
  ros::init(argc, argv, "manager");
  const bool is_standalone = argc == 3 && std::string(argv[1]) == "standalone";
  if (argc > 1 && !is_standalone)
  {
    std::fprintf(stderr, "usage: %s [standalone PACKAGE/TYPE]\n", argv[0]);
    return 2;
  }
  auto* loader = new nodelet::Loader;  // never freed
  const bool is_ready = !is_standalone || loadAlone(*loader, argv[2]);
  if (is_ready) ros::spin();
  loader->clear();
  ros::shutdown();
  std::fflush(nullptr);
  std::quick_exit(is_ready ? EXIT_SUCCESS : EXIT_FAILURE);
}
