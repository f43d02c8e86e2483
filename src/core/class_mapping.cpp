#include "lidar_panoptic_clustering/core/class_mapping.h"

#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
ClassIndex counterpart(const ClassInfo& info, const ClassTable& to)
{
  const auto lead = [&to](const std::string& name)
  {
    const ClassIndex named = to.findByName(name);
    return named != kUnknownClass ? named : to.findByAlias(name);
  };
  ClassIndex found = lead(info.name);
  for (std::size_t i = 0; found == kUnknownClass && i < info.aliases.size(); ++i) found = lead(info.aliases[i]);
  if (found != kUnknownClass) return found;
  return to.findByName(info.isThing() ? "object" : "structure");
}
}  // namespace

std::uint32_t ignoredId(const ClassTable& table)
{
  for (std::size_t i = 1; i < table.size(); ++i)
  {
    const ClassInfo& info = table[static_cast<ClassIndex>(i)];
    if (info.kind == ClassKind::kIgnored) return info.ids[0];
  }
  return ClassMapping::kUnmapped;
}

ClassMapping::ClassMapping(const ClassTable& from, const ClassTable& to)
{
  std::uint32_t largest = 0;
  for (std::size_t i = 1; i < from.size(); ++i)
    for (const std::uint32_t id : from[static_cast<ClassIndex>(i)].ids) largest = std::max(largest, id);
  last_ = std::size_t{largest} + 1;
  id_of_.assign(last_ + 1, ignoredId(to));

  for (std::size_t i = 1; i < from.size(); ++i)
  {
    const ClassInfo& info = from[static_cast<ClassIndex>(i)];
    if (info.kind == ClassKind::kIgnored) continue;
    const ClassIndex found = counterpart(info, to);
    if (found == kUnknownClass) continue;
    for (const std::uint32_t id : info.ids) id_of_[id] = to[found].ids[0];
  }
}
}  // namespace lidar_panoptic_clustering
