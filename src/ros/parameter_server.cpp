#include "ros/parameter_server.h"

#include <xmlrpcpp/XmlRpcValue.h>

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
}  // namespace lidar_panoptic_clustering
