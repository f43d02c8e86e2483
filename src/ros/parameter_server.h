#pragma once

#include "lidar_panoptic_clustering/core/parameters.h"

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The parameters named in `known` that are set in the namespace of `nh`, each of the type of its `value` (an integer
/// is fine where a double is expected); others on the server are ignored. Ranges and choices are left to
/// applyParameters. Throws std::invalid_argument, naming the full parameter name, on any other type.
ParameterMap readParameters(const ros::NodeHandle& nh, const std::vector<ParameterInfo>& known);

/// What is set in the namespace of `nh` and used by nobody.
struct UnusedParameters
{
  std::vector<std::string> unknown;    ///< a sentence each, with the name that was meant
  std::vector<std::string> of_others;  ///< full names
};

/// Looks for names that are not in `known`, in the namespace of `nh` and one level deeper, where a file's parameters
/// stand below a heading; there only for those that are or resemble known ones, and not below the name of a node. Names
/// in `others` are those of the nodelet's alternatives, which a file may set as well. ROS's own names
/// (diagnostic_period and such) are left alone.
UnusedParameters findUnusedParameters(const ros::NodeHandle& nh, const std::vector<std::string>& known,
                                      const std::vector<std::string>& others = {});

/// Looks for them, logs a warning on each unknown one under the nodelet's name and returns the warnings as one line,
/// empty where there is none.
std::string warnOfUnusedParameters(const ros::NodeHandle& nh, const std::vector<std::string>& known,
                                   const std::vector<std::string>& others = {});

/// The names of parameters, those in `more` after them.
std::vector<std::string> namesOf(const std::vector<ParameterInfo>& parameters, std::vector<std::string> more = {});
}  // namespace lidar_panoptic_clustering
