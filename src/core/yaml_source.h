#pragma once

#include <yaml-cpp/yaml.h>

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

/// Throws std::invalid_argument, naming `source`, where it is not YAML.
YAML::Node parseYaml(const std::string& yaml, const std::string& source);

std::vector<std::string> namesOf(const std::map<std::string, std::string>& shipped);
}  // namespace lidar_panoptic_clustering
