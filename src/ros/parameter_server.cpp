#include "ros/parameter_server.h"

#include "lidar_panoptic_clustering/core/nearest_name.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
const char* expectedType(const ParameterValue& value)
{
  constexpr const char* kNames[] = {"a bool", "an integer", "a number", "a string"};
  return kNames[value.index()];
}

const char* typeName(XmlRpc::XmlRpcValue::Type type)
{
  switch (type)
  {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return "a bool";
    case XmlRpc::XmlRpcValue::TypeInt:
      return "an integer";
    case XmlRpc::XmlRpcValue::TypeDouble:
      return "a floating-point number";
    case XmlRpc::XmlRpcValue::TypeString:
      return "a string";
    case XmlRpc::XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpc::XmlRpcValue::TypeStruct:
      return "a namespace";
    default:
      return "another type";
  }
}

ParameterValue convert(const std::string& full_name, XmlRpc::XmlRpcValue& raw, const ParameterValue& expected)
{
  using XmlRpc::XmlRpcValue;
  const auto type = raw.getType();
  if (std::holds_alternative<bool>(expected) && type == XmlRpcValue::TypeBoolean) return static_cast<bool&>(raw);
  if (std::holds_alternative<int>(expected) && type == XmlRpcValue::TypeInt) return static_cast<int&>(raw);
  if (std::holds_alternative<double>(expected))
  {
    if (type == XmlRpcValue::TypeDouble) return static_cast<double&>(raw);
    if (type == XmlRpcValue::TypeInt) return static_cast<double>(static_cast<int&>(raw));
  }
  if (std::holds_alternative<std::string>(expected) && type == XmlRpcValue::TypeString)
    return static_cast<std::string&>(raw);
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message << "parameter " << full_name << ": expected " << expectedType(expected) << ", got " << typeName(type) << ' '
          << raw;
  throw std::invalid_argument(message.str());
}

bool contains(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Names that roscpp, nodelet managers, tf, bond and diagnostic_updater read in a node's namespace.
bool isOfRos(const std::string& name)
{
  static const std::vector<std::string> names = {"num_worker_threads", "use_sim_time", "tf_prefix", "enable_statistics",
                                                 "bond_disable_heartbeat_timeout"};
  return name.rfind("diagnostic_", 0) == 0 || contains(names, name);
}

bool isNode(const std::string& full_name)
{
  ros::V_string nodes;
  return ros::master::getNodes(nodes) && contains(nodes, full_name);
}

std::string joined(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void checkBelow(const std::string& heading, XmlRpc::XmlRpcValue& values, const std::string& space,
                const std::vector<std::string>& known, UnusedParameters& unused)
{
  for (const auto& [name, value] : values)
  {
    const bool is_known = contains(known, name);
    const std::string meant = is_known ? name : nearestName(name, known);
    if (meant.empty() || isNode(heading)) continue;
    unused.unknown.push_back("unknown parameter " + heading + "/" + name + ": nobody uses it" +
                             (is_known ? ", it lies one level too deep; expected " + space + "/" + meant
                                       : "; did you mean " + space + "/" + meant + ", one level higher?"));
  }
}
}  // namespace

ParameterMap readParameters(const ros::NodeHandle& nh, const std::vector<ParameterInfo>& known)
{
  ParameterMap values;
  for (const auto& info : known)
  {
    XmlRpc::XmlRpcValue raw;
    if (nh.getParam(info.name, raw)) values.emplace(info.name, convert(nh.resolveName(info.name), raw, info.value));
  }
  return values;
}

UnusedParameters findUnusedParameters(const ros::NodeHandle& nh, const std::vector<std::string>& known,
                                      const std::vector<std::string>& others)
{
  UnusedParameters unused;
  const std::string space = nh.getNamespace() == "/" ? "" : nh.getNamespace();
  XmlRpc::XmlRpcValue values;
  if (!ros::param::get(nh.getNamespace(), values) || values.getType() != XmlRpc::XmlRpcValue::TypeStruct) return unused;
  for (auto& [name, value] : values)
  {
    const std::string full_name = space + "/" + name;
    if (contains(known, name) || isOfRos(name)) continue;
    if (value.getType() == XmlRpc::XmlRpcValue::TypeStruct)
    {
      checkBelow(full_name, value, space, known, unused);
      continue;
    }
    if (contains(others, name))
    {
      unused.of_others.push_back(full_name);
      continue;
    }
    const std::string meant = nearestName(name, known);
    unused.unknown.push_back("unknown parameter " + full_name + ": nobody uses it; " +
                             (meant.empty() ? "there are: " + joined(known) : "did you mean '" + meant + "'?"));
  }
  return unused;
}

std::string warnOfUnusedParameters(const ros::NodeHandle& nh, const std::vector<std::string>& known,
                                   const std::vector<std::string>& others)
{
  const UnusedParameters unused = findUnusedParameters(nh, known, others);
  const std::string& logger = nh.getNamespace();  // as NODELET_WARN names it
  std::string warnings;
  for (const std::string& warning : unused.unknown)
  {
    ROS_WARN_NAMED(logger, "%s", warning.c_str());
    warnings += (warnings.empty() ? "" : "; ") + warning;
  }
  if (!unused.of_others.empty())
    ROS_INFO_NAMED(logger, "parameters of other algorithms, not used here: %s", joined(unused.of_others).c_str());
  return warnings;
}

std::vector<std::string> namesOf(const std::vector<ParameterInfo>& parameters, std::vector<std::string> more)
{
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : parameters) names.push_back(parameter.name);
  names.insert(names.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return names;
}
}  // namespace lidar_panoptic_clustering
