#include "lidar_panoptic_clustering/core/class_table.h"

#include "core/plain_numbers.h"
#include "core/yaml_source.h"
#include "shipped_files.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
// SemanticKITTI keeps the class in the low 16 bits of a label; no convention known has larger ids.
constexpr std::int64_t kMaxRawId = 0xFFFF;
constexpr std::size_t kMaxClasses = 255;

/// Reads one entry of `classes`; `where` ("FILE: class 'car'") begins each message.
class ClassReader
{
public:
  ClassReader(const YAML::Node& node, std::string where) : node_(node), where_(std::move(where)) {}

  ClassInfo read(std::string& group) const
  {
    ClassInfo info;
    info.name = required<std::string>("name", "a name");
    info.kind = readKind();
    info.ids = readIds();
    info.rgb = readColor();
    if (node_["aliases"]) info.aliases = required<std::vector<std::string>>("aliases", "a list of class names");
    if (!info.isThing()) return info;

    group = node_["group"] ? required<std::string>("group", "a name") : info.name;
    const auto size = required<std::vector<float>>("size", "[length, width] in metres");
    if (size.size() != 2 || !(size[1] > 0.0F) || !(size[0] >= size[1]))
      fail("size must be [length, width] in metres with length >= width > 0");
    info.length_m = inRange("length", size[0], kLeastSize, kMostSize);
    info.width_m = inRange("width", size[1], kLeastSize, kMostSize);
    info.link_distance_m = inRange("link", required<float>("link", "a distance in metres"), kLeastLink, kMostLink);
    return info;
  }

private:
  // [m]: with these, and whatever parameters scale them, the algorithms' grids hold every scan
  static constexpr float kLeastSize = 0.01F, kMostSize = 1000.0F, kLeastLink = 0.05F, kMostLink = 100.0F;

  [[noreturn]] void fail(const std::string& what) const { throw std::invalid_argument(where_ + ": " + what); }

  template <class T>
  T required(const char* key, const char* expected) const
  {
    if (!node_[key]) fail(std::string("has no '") + key + "', expected " + expected);
    T value{};
    if (!readYaml(node_[key], value)) fail(std::string("'") + key + "' must be " + expected);
    return value;
  }

  float inRange(const char* what, float metres, float least, float most) const
  {
    if (!(metres >= least && metres <= most))
      fail(std::string(what) + " must be from " + shortText(least) + " to " + shortText(most) + " m, found " +
           shortText(metres));
    return metres;
  }

  std::vector<std::uint32_t> readIds() const
  {
    std::vector<std::uint32_t> ids;
    for (const std::int64_t id : required<std::vector<std::int64_t>>("ids", "a list of raw ids"))
    {
      if (id < 0) fail("id " + std::to_string(id) + " is below 0");
      if (id > kMaxRawId) fail("id " + std::to_string(id) + " is above 65535");
      if (std::find(ids.begin(), ids.end(), id) != ids.end()) fail("id " + std::to_string(id) + " is there twice");
      ids.push_back(static_cast<std::uint32_t>(id));
    }
    if (ids.empty()) fail("ids is empty, expected at least one raw id");
    return ids;
  }

  std::uint32_t readColor() const
  {
    const auto color = required<std::vector<std::int64_t>>("color", "[red, green, blue]");
    if (color.size() != 3 || std::any_of(color.begin(), color.end(), [](std::int64_t c) { return c < 0 || c > 255; }))
      fail("color must be [red, green, blue], each from 0 to 255");
    return static_cast<std::uint32_t>(color[0] << 16 | color[1] << 8 | color[2]);
  }

  ClassKind readKind() const
  {
    const auto kind = required<std::string>("kind", "ignored, stuff or thing");
    if (kind == "ignored") return ClassKind::kIgnored;
    if (kind == "stuff") return ClassKind::kStuff;
    if (kind == "thing") return ClassKind::kThing;
    fail("kind is '" + kind + "', expected ignored, stuff or thing");
  }

  YAML::Node node_;
  std::string where_;
};
}  // namespace

ClassTable ClassTable::parse(const std::string& yaml, const std::string& source)
try
{
  const YAML::Node root = parseYaml(yaml, source);
  if (!root.IsMap() || !root["classes"] || !root["classes"].IsSequence())
    throw std::invalid_argument(source + ": expected a map with a list 'classes'");

  ClassTable table;
  table.name_ = root["name"] ? root["name"].as<std::string>() : source;
  if (root["minus_one"])
  {
    if (!root["minus_one"].IsScalar() || root["minus_one"].Scalar() != "ignored")
      throw std::invalid_argument(source + ": minus_one must be 'ignored', or not there");
    table.ignores_minus_one_ = true;
  }
  table.classes_.push_back({"unknown", ClassKind::kIgnored, {}, 0x808080, 0, 0.0F, 0.0F, 0.0F, {}});
  table.groups_.push_back("");

  for (const YAML::Node& node : root["classes"])
  {
    if (!node.IsMap() || !node["name"] || !node["name"].IsScalar())
      throw std::invalid_argument(source + ": class " + std::to_string(table.size()) + " has no 'name'");
    const std::string where = source + ": class '" + node["name"].as<std::string>() + "'";
    if (table.size() > kMaxClasses) throw std::invalid_argument(where + ": more than 255 classes");

    std::string group;
    ClassInfo info = ClassReader(node, where).read(group);
    if (table.findByName(info.name) != kUnknownClass) throw std::invalid_argument(where + " is there twice");
    const auto index = static_cast<ClassIndex>(table.size());
    for (const std::uint32_t id : info.ids)
    {
      if (table.find(id) != kUnknownClass)
        throw std::invalid_argument(where + ": id " + std::to_string(id) + " already belongs to class '" +
                                    table[table.find(id)].name + "'");
      if (id >= table.class_of_id_.size()) table.class_of_id_.resize(id + 1, kUnknownClass);
      table.class_of_id_[id] = index;
    }
    const auto found = std::find(table.groups_.begin(), table.groups_.end(), group);
    info.group = static_cast<std::uint8_t>(found - table.groups_.begin());
    if (found == table.groups_.end()) table.groups_.push_back(group);
    table.classes_.push_back(std::move(info));
  }
  if (table.size() == 1) throw std::invalid_argument(source + ": the list 'classes' is empty");
  for (const ClassIndex index : table.class_of_id_)
  {
    table.kind_of_id_.push_back(table[index].kind);
    table.rgb_of_id_.push_back(table[index].rgb);
  }
  table.checkAliases(source);
  return table;
}
catch (const YAML::Exception& error)
{
  throw std::invalid_argument(source + ": " + error.what());
}

ClassTable ClassTable::load(const std::string& name_or_path)
{
  const YamlSource yaml = readYamlSource("class table", shippedClassTables(), name_or_path);
  return parse(yaml.text, yaml.source);
}

std::vector<std::string> ClassTable::shippedNames()
{
  return namesOf(shippedClassTables());
}

ClassIndex ClassTable::findByName(const std::string& name) const
{
  for (std::size_t i = 1; i < classes_.size(); ++i)
    if (classes_[i].name == name) return static_cast<ClassIndex>(i);
  return kUnknownClass;
}

ClassIndex ClassTable::findByAlias(const std::string& name) const
{
  for (std::size_t i = 1; i < classes_.size(); ++i)
  {
    const auto& aliases = classes_[i].aliases;
    if (std::find(aliases.begin(), aliases.end(), name) != aliases.end()) return static_cast<ClassIndex>(i);
  }
  return kUnknownClass;
}

/// A name stands for one class at most.
void ClassTable::checkAliases(const std::string& source) const
{
  for (std::size_t i = 1; i < classes_.size(); ++i)
    for (const std::string& alias : classes_[i].aliases)
    {
      const ClassIndex named = findByName(alias), owner = named != kUnknownClass ? named : findByAlias(alias);
      if (owner == i) continue;
      throw std::invalid_argument(source + ": class '" + classes_[i].name + "': alias '" + alias +
                                  "' already belongs to class '" + classes_[owner].name + "'");
    }
}
}  // namespace lidar_panoptic_clustering
