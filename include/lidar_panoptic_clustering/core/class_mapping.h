#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// From the raw ids of one label convention to those of another, by the names of their classes.
///
/// A class goes where its name leads: to the target's class of that name, else to the one that has it among its
/// aliases; where neither is, each of its own aliases is tried in the same way, in its order. Where no name leads
/// anywhere, a thing becomes the target's class "object" and stuff its class "structure", if it has them. The rest,
/// classes that are ignored or unknown included, goes to the target's first ignored class, or to kUnmapped where it has
/// none.
class ClassMapping
{
public:
  /// An id that no class table names.
  static constexpr std::uint32_t kUnmapped = 0xFFFFFFFFU;

  ClassMapping(const ClassTable& from, const ClassTable& to);

  /// The canonical raw id of the target's class, for any 32-bit id: one load from a flat array.
  std::uint32_t operator()(std::uint32_t raw_id) const { return id_of_[std::min<std::size_t>(raw_id, last_)]; }

private:
  std::vector<std::uint32_t> id_of_;  ///< by raw id; the last entry stands for all beyond the table
  std::size_t last_;
};

/// The canonical id of the table's first ignored class; ClassMapping::kUnmapped where it has none.
std::uint32_t ignoredId(const ClassTable& table);
}  // namespace lidar_panoptic_clustering
