#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <map>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Parameters by name, as they come from a command line, a launch file or dynamic_reconfigure.
///
/// A config struct holds the defaults and lists its members once, in a static `visit(self, visitor)`, which calls
/// `visitor(name, member, min, max)` for numbers, `visitor(name, member)` for bool and
/// `visitor(name, member, choices)` for text, with no choices for free text. All else here follows from that list.
using ParameterValue = std::variant<bool, int, double, std::string>;
using ParameterMap = std::map<std::string, ParameterValue>;

/// Distances that 0 switches off are this or more where they are on [m]: below lies the rounding of coordinates.
constexpr double kLeastDistanceM = 0.001;

struct ParameterInfo
{
  std::string name;
  ParameterValue value;  ///< of the member's own type
  double min = 0.0, max = 0.0;
  std::vector<std::string> choices;
};

/// As a command line takes it: true, 5, 0.35.
std::string parameterText(const ParameterValue& value);

namespace detail
{
/// Each throws std::invalid_argument that names the parameter, what it allows and what came.
int toInt(const std::string& name, const ParameterValue& value, int min, int max);
double toDouble(const std::string& name, const ParameterValue& value, double min, double max);
bool toBool(const std::string& name, const ParameterValue& value);
std::string toChoice(const std::string& name, const ParameterValue& value, const std::vector<std::string>& choices);
[[noreturn]] void throwUnknown(const std::string& name, const std::vector<ParameterInfo>& known);

/// Sets the members that `given` names, and counts them.
struct Applier
{
  const ParameterMap& given;
  std::size_t applied = 0;

  void operator()(const char* name, int& member, int min, int max)
  {
    if (const auto it = given.find(name); it != given.end()) member = toInt(name, it->second, min, max), ++applied;
  }
  void operator()(const char* name, double& member, double min, double max)
  {
    if (const auto it = given.find(name); it != given.end()) member = toDouble(name, it->second, min, max), ++applied;
  }
  void operator()(const char* name, bool& member)
  {
    if (const auto it = given.find(name); it != given.end()) member = toBool(name, it->second), ++applied;
  }
  void operator()(const char* name, std::string& member, const std::vector<std::string>& choices)
  {
    if (const auto it = given.find(name); it != given.end()) member = toChoice(name, it->second, choices), ++applied;
  }
};

struct Describer
{
  std::vector<ParameterInfo> list;

  void operator()(const char* name, int value, int min, int max)
  {
    list.push_back({name, value, static_cast<double>(min), static_cast<double>(max), {}});
  }
  void operator()(const char* name, double value, double min, double max)
  {
    list.push_back({name, value, min, max, {}});
  }
  void operator()(const char* name, bool value) { list.push_back({name, value, 0.0, 0.0, {}}); }
  void operator()(const char* name, const std::string& value, const std::vector<std::string>& choices)
  {
    list.push_back({name, value, 0.0, 0.0, choices});
  }
};
}  // namespace detail

/// The parameters of a config with their present values, ranges and choices.
template <class Config>
std::vector<ParameterInfo> describeParameters(const Config& config = {})
{
  detail::Describer describer;
  Config::visit(config, describer);
  return describer.list;
}

/// Sets the members of `config` named in `given`; other names are left to the caller. Returns how many were set.
/// Throws std::invalid_argument on a value of the wrong type or outside the range.
template <class Config>
std::size_t applyKnownParameters(Config& config, const ParameterMap& given)
{
  detail::Applier applier{given};
  Config::visit(config, applier);
  return applier.applied;
}

/// As applyKnownParameters, but a name the config does not have is an error too.
template <class Config>
void applyParameters(Config& config, const ParameterMap& given)
{
  if (applyKnownParameters(config, given) == given.size()) return;
  const auto known = describeParameters(config);
  for (const auto& [name, value] : given)
  {
    bool found = false;
    for (const auto& info : known) found = found || info.name == name;
    if (!found) detail::throwUnknown(name, known);
  }
}

/// Throws std::invalid_argument when a distance is neither 0, for off, nor kLeastDistanceM to `max`.
void requireOffOrDistance(const std::string& name, double metres, double max);

/// Throws std::invalid_argument when a member is outside its range.
template <class Config>
void validateParameters(const Config& config)
{
  ParameterMap values;
  for (auto& info : describeParameters(config)) values.emplace(info.name, info.value);
  Config copy;
  applyKnownParameters(copy, values);
}
}  // namespace lidar_panoptic_clustering
