#include "core/yaml_source.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
YamlSource readYamlSource(const std::string& kind, const std::map<std::string, std::string>& shipped,
                          const std::string& name_or_path)
{
  const auto found = shipped.find(name_or_path);
  if (found != shipped.end()) return {found->second, found->first};

  std::ifstream file(name_or_path);
  std::stringstream text;
  text << file.rdbuf();
  if (!std::filesystem::is_regular_file(name_or_path) || !file.is_open() || file.bad())
  {
    std::string known;
    for (const auto& name : namesOf(shipped)) known += ", " + name;
    throw std::runtime_error(kind + " '" + name_or_path + "': cannot be read; expected a YAML file or one of" +
                             known.substr(1));
  }
  return {text.str(), name_or_path};
}

YAML::Node parseYaml(const std::string& yaml, const std::string& source)
{
  try
  {
    return YAML::Load(yaml);
  }
  catch (const YAML::Exception& error)
  {
    throw std::invalid_argument(source + ": not a YAML file: " + error.what());
  }
}

std::vector<std::string> namesOf(const std::map<std::string, std::string>& shipped)
{
  std::vector<std::string> names;
  for (const auto& [name, yaml] : shipped) names.push_back(name);
  return names;
}
}  // namespace lidar_panoptic_clustering
