#include "core/yaml_source.h"

#include "core/input_file.h"
#include "core/plain_numbers.h"
#include "core/printable.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint64_t kMaxYamlFile = 1U << 20U;  // the largest of ours has 6 kB
constexpr int kMaxDepth = 64;

/// How deep brackets, and dashes one behind the other, go at most: yaml-cpp reads each level by a call of its own,
/// older releases without a bound. Brackets in text and comments count too.
int depthOf(const std::string& yaml)
{
  int open = 0, dashes = 0, deepest = 0;
  for (std::size_t i = 0; i < yaml.size(); ++i)
  {
    const char c = yaml[i];
    if (c == '[' || c == '{') ++open;
    if (c == ']' || c == '}') open = std::max(0, open - 1);
    if ((c == '-' || c == '?') && i + 1 < yaml.size() && yaml[i + 1] == ' ')
      ++dashes;
    else if (c != ' ')
      dashes = 0;
    deepest = std::max({deepest, open, dashes});
  }
  return deepest;
}

/// With a blank behind each ':' that stands right before ']' or the end. Inside of brackets yaml-cpp 0.6 never comes to
/// an end there; with the blank it reads what 0.7 and later read without. The byte 4 is an end to it. (In a text in
/// quotes the blank is read too; no name has such.)
std::string withBlanks(const std::string& yaml)
{
  std::string text;
  text.reserve(yaml.size() + 1);
  for (std::size_t i = 0; i < yaml.size(); ++i)
  {
    text += yaml[i];
    const char next = i + 1 < yaml.size() ? yaml[i + 1] : '\4';
    if (yaml[i] == ':' && (next == ']' || next == '\4')) text += ' ';
  }
  return text;
}
}  // namespace

YamlSource readYamlSource(const std::string& kind, const std::map<std::string, std::string>& shipped,
                          const std::string& name_or_path)
{
  const auto found = shipped.find(name_or_path);
  if (found != shipped.end()) return {found->second, found->first};
  if (!std::filesystem::is_regular_file(name_or_path))
  {
    std::string known;
    for (const auto& name : namesOf(shipped)) known += ", " + name;
    throw std::runtime_error(kind + " '" + name_or_path + "': cannot be read; expected a YAML file or one of" +
                             known.substr(1));
  }
  return {readTextFile(name_or_path, kMaxYamlFile), name_or_path};
}

YAML::Node parseYaml(const std::string& yaml, const std::string& source)
{
  if (yaml.find('\0') != std::string::npos)  // UTF-16 too, in which what follows would find nothing
    throw std::invalid_argument(source + ": holds a byte of 0, expected a text in UTF-8");
  if (depthOf(yaml) > kMaxDepth)
    throw std::invalid_argument(source + ": nested more than " + std::to_string(kMaxDepth) + " deep");
  try
  {
    return YAML::Load(withBlanks(yaml));
  }
  catch (const YAML::Exception& error)
  {
    throw std::invalid_argument(source + ": not a YAML file: " + error.what());
  }
}

bool readYaml(const YAML::Node& node, std::string& value)
{
  if (!node.IsScalar()) return false;
  value = node.Scalar();
  return true;
}

bool readYaml(const YAML::Node& node, std::int64_t& value)
{
  if (!node.IsScalar()) return false;
  const std::string& text = node.Scalar();
  const bool hexadecimal = text.rfind("0x", 0) == 0;
  const char *begin = text.data() + (hexadecimal ? 2 : 0), *end = text.data() + text.size();
  const auto [last, error] = std::from_chars(begin, end, value, hexadecimal ? 16 : 10);
  return error == std::errc() && last == end && !(hexadecimal && *begin == '-');
}

bool readYaml(const YAML::Node& node, double& value)
{
  if (!node.IsScalar()) return false;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::string& text = node.Scalar();
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return value = std::numeric_limits<double>::quiet_NaN(), true;
  if (text == ".inf" || text == "+.inf") return value = kInfinity, true;
  if (text == "-.inf") return value = -kInfinity, true;
  const auto number = parseNumber(text);
  if (number) value = *number;
  return number.has_value();
}

bool readYaml(const YAML::Node& node, float& value)
{
  double number = 0.0;
  if (!readYaml(node, number)) return false;
  constexpr double kLargest = std::numeric_limits<float>::max();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  value = number > kLargest ? kInfinity : number < -kLargest ? -kInfinity : static_cast<float>(number);
  return true;
}

std::string describeYaml(const YAML::Node& node)
{
  constexpr std::size_t kMostShown = 60;
  if (node.IsScalar()) return printable(node.Scalar().substr(0, kMostShown), false);
  if (!node.IsSequence()) return node.IsMap() ? "a map" : "nothing";
  std::string list;
  for (std::size_t i = 0; i < node.size() && list.size() < kMostShown; ++i)
    list += (i == 0 ? "" : ", ") + (node[i].IsScalar() ? node[i].Scalar() : std::string(".."));
  return printable("[" + list.substr(0, kMostShown) + "]", false);
}

std::vector<std::string> namesOf(const std::map<std::string, std::string>& shipped)
{
  std::vector<std::string> names;
  for (const auto& [name, yaml] : shipped) names.push_back(name);
  return names;
}
}  // namespace lidar_panoptic_clustering
