#include "lidar_panoptic_clustering/core/class_bridging.h"

namespace lidar_panoptic_clustering
{
void ClassBridging::join(const ThingScan& scan, const ClassTable& table, float distance,
                         const std::vector<RefinedObject>& objects, const std::vector<std::uint32_t>& object_of_thing,
                         std::vector<std::uint32_t>& whole_of)
{
  sets_.reset(objects.size());
  if (distance > 0.0F)
  {
    cells_.clear(scan.size());
    for (std::uint32_t i = 0; i < scan.size(); ++i)
      cells_.add(scan.points[i].x, scan.points[i].y, static_cast<std::int32_t>(object_of_thing[i]), distance, i);
    cells_.close();
    stackCells(objects, table);

    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
    {
      const VoxelKey key = cells_.key(cell);
      const auto object = static_cast<std::uint32_t>(key.z);
      const ClassInfo& info = table[objects[object].class_index];
      for (int dy = -PlanarCells::kReach; dy <= PlanarCells::kReach; ++dy)
        for (int dx = -PlanarCells::kReach; dx <= PlanarCells::kReach; ++dx)
        {
          const std::uint32_t stack = stacks_.find({key.x + dx, key.y + dy, info.group});
          if (stack == VoxelIndex::kNone) continue;
          for (std::uint32_t other = top_[stack]; other != PlanarCells::kNone; other = below_[other])
          {
            const auto other_object = static_cast<std::uint32_t>(cells_.key(other).z);
            if (other_object >= object) continue;  // each pair once
            if (sets_.find(object) == sets_.find(other_object)) continue;
            if (cells_.areCloser(cell, other, distance)) sets_.unite(object, other_object);
          }
        }
    }
  }
  sets_.flatten(whole_of);
}

/// Lists the cells that lie in one place, of objects of one group.
void ClassBridging::stackCells(const std::vector<RefinedObject>& objects, const ClassTable& table)
{
  stacks_.reset(cells_.size());
  top_.clear();
  below_.resize(cells_.size());
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
  {
    const VoxelKey key = cells_.key(cell);
    const std::uint8_t group = table[objects[static_cast<std::size_t>(key.z)].class_index].group;
    const std::uint32_t stack = stacks_.insert({key.x, key.y, group});
    if (stack == top_.size()) top_.push_back(PlanarCells::kNone);
    below_[cell] = top_[stack];
    top_[stack] = cell;
  }
}
}  // namespace lidar_panoptic_clustering
