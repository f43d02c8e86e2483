#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// YAML text and what to call it in messages.
struct YamlSource
{
  std::string text, source;
};

/// The text shipped under the name `name_or_path`, else that of the file there. Throws std::runtime_error that names
/// what is looked for (`kind`) and lists the names where there is neither.
YamlSource readYamlSource(const std::string& kind, const std::map<std::string, std::string>& shipped,
                          const std::string& name_or_path);

/// Throws std::invalid_argument, naming `source`, where it is not YAML in UTF-8 or nested deeper than any file of ours.
/// Comes to an end with any text.
YAML::Node parseYaml(const std::string& yaml, const std::string& source);

/// Each reads a node by its text alone, by the same rules for every version of yaml-cpp and without the locale; false
/// where it is something else. Whole numbers are decimal or 0x..; what does not fit into 64 bits is none. Numbers may
/// be .nan, .inf and -.inf.
bool readYaml(const YAML::Node& node, std::string& value);
bool readYaml(const YAML::Node& node, std::int64_t& value);
bool readYaml(const YAML::Node& node, double& value);
bool readYaml(const YAML::Node& node, float& value);

template <class T>
bool readYaml(const YAML::Node& node, std::vector<T>& values)
{
  if (!node.IsSequence()) return false;
  values.clear();
  for (const YAML::Node& entry : node)
    if (!readYaml(entry, values.emplace_back())) return false;
  return true;
}

/// For messages: the text of a scalar, else what it is.
std::string describeYaml(const YAML::Node& node);

std::vector<std::string> namesOf(const std::map<std::string, std::string>& shipped);
}  // namespace lidar_panoptic_clustering
