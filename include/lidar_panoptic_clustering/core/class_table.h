#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A class's place in its table; 0 stands for every raw id the table does not name.
using ClassIndex = std::uint8_t;
constexpr ClassIndex kUnknownClass = 0;

enum class ClassKind : std::uint8_t
{
  kIgnored,  ///< neither clustered nor evaluated
  kStuff,
  kThing
};

struct ClassInfo
{
  std::string name;
  ClassKind kind = ClassKind::kIgnored;
  std::vector<std::uint32_t> ids;  ///< raw ids; the first is the canonical one, written to prediction files
  std::uint32_t rgb = 0;           ///< 0x00RRGGBB
  std::uint8_t group = 0;          ///< classes a network confuses share a group, see ClassTable::groupName
  float length_m = 0.0F;           ///< usual size in bird's-eye view, length >= width; things only
  float width_m = 0.0F;
  float link_distance_m = 0.0F;      ///< the widest gap between neighbouring points of one object; things only
  std::vector<std::string> aliases;  ///< names of other tables' classes that this one covers, the nearest first

  bool isThing() const { return kind == ClassKind::kThing; }
};

/// The classes of one label convention: the one place where a class is known by number.
///
/// Read from YAML (config/*.yaml). A look-up is one load from a flat array, for any 32-bit id.
class ClassTable
{
public:
  /// `name_or_path`: a table that ships with the package (shippedNames()), or a YAML file.
  /// Throws std::runtime_error when there is no such file, std::invalid_argument when its content is wrong;
  /// both name the file, the class, and what was expected.
  static ClassTable load(const std::string& name_or_path);
  static ClassTable parse(const std::string& yaml, const std::string& source);
  /// The tables that ship with the package.
  static std::vector<std::string> shippedNames();

  const std::string& name() const { return name_; }

  /// kUnknownClass for ids outside the table.
  ClassIndex find(std::uint32_t raw_id) const
  {
    return raw_id < class_of_id_.size() ? class_of_id_[raw_id] : kUnknownClass;
  }
  /// The same as (*this)[find(raw_id)].kind, .rgb, without a look at the class.
  ClassKind kindOf(std::uint32_t raw_id) const
  {
    return raw_id < kind_of_id_.size() ? kind_of_id_[raw_id] : ClassKind::kIgnored;
  }
  std::uint32_t rgbOf(std::uint32_t raw_id) const
  {
    return raw_id < rgb_of_id_.size() ? rgb_of_id_[raw_id] : classes_[kUnknownClass].rgb;
  }
  /// The class called `name`; kUnknownClass where there is none.
  ClassIndex findByName(const std::string& name) const;
  /// The class that has `name` among its aliases; kUnknownClass where there is none.
  ClassIndex findByAlias(const std::string& name) const;

  const ClassInfo& operator[](ClassIndex index) const { return classes_[index]; }
  /// Number of classes, the unknown class at index 0 included: valid indices are 0..size()-1.
  std::size_t size() const { return classes_.size(); }
  /// Whether -1 stands for no class in this convention ("minus_one: ignored").
  bool ignoresMinusOne() const { return ignores_minus_one_; }
  const std::string& groupName(std::uint8_t group) const { return groups_[group]; }
  std::size_t groupCount() const { return groups_.size(); }

private:
  void checkAliases(const std::string& source) const;

  std::string name_;
  std::vector<ClassInfo> classes_;
  std::vector<std::string> groups_;
  bool ignores_minus_one_ = false;
  std::vector<ClassIndex> class_of_id_;  ///< by raw id, as are the next two
  std::vector<ClassKind> kind_of_id_;
  std::vector<std::uint32_t> rgb_of_id_;
};
}  // namespace lidar_panoptic_clustering
