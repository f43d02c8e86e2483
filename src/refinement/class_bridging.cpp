#include "lidar_panoptic_clustering/refinement/class_bridging.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr float kRounding = 1.001F;     // outlines are never to exclude what points would join
constexpr std::size_t kMostPairs = 32;  // an object, in the mean; in a denser heap all points are looked at
}  // namespace

void ClassBridging::Reach::add(const Footprint& other, float distance)
{
  min_x = std::min(min_x, other.minX() - distance), max_x = std::max(max_x, other.maxX() + distance);
  min_y = std::min(min_y, other.minY() - distance), max_y = std::max(max_y, other.maxY() + distance);
}

void ClassBridging::join(const ThingScan& scan, const ClassTable& table, float distance,
                         const std::vector<RefinedObject>& objects, const std::vector<std::uint32_t>& object_of_thing,
                         std::vector<std::uint32_t>& whole_of)
{
  sets_.reset(objects.size());
  if (distance > 0.0F && findReaches(objects, table, kRounding * distance))
  {
    sortByGroup(scan, table, objects, object_of_thing);
    for (const auto& things : things_of_group_)
      if (things.size() > 1) uniteClose(scan, things, distance, object_of_thing);
  }
  sets_.flatten(whole_of);
}

/// Sweeps over the objects along x. Returns whether any two of a group may be near.
bool ClassBridging::findReaches(const std::vector<RefinedObject>& objects, const ClassTable& table, float distance)
{
  reach_.assign(objects.size(), {kFar, -kFar, kFar, -kFar});
  order_.resize(objects.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::sort(order_.begin(), order_.end(),
            [&objects](std::uint32_t a, std::uint32_t b)
            { return objects[a].footprint.minX() < objects[b].footprint.minX(); });

  bool found = false;
  std::size_t pairs_left = kMostPairs * objects.size();
  for (std::size_t i = 0; i < order_.size(); ++i)
  {
    const RefinedObject& a = objects[order_[i]];
    for (std::size_t j = i + 1; j < order_.size(); ++j)
    {
      const RefinedObject& b = objects[order_[j]];
      if (b.footprint.minX() - a.footprint.maxX() >= distance) break;
      if (pairs_left-- == 0)
      {
        reach_.assign(objects.size(), {-kFar, kFar, -kFar, kFar});
        return true;
      }
      if (table[a.class_index].group != table[b.class_index].group) continue;
      if (!a.footprint.mayBeCloser(b.footprint, distance)) continue;
      reach_[order_[i]].add(b.footprint, distance);
      reach_[order_[j]].add(a.footprint, distance);
      found = true;
    }
  }
  return found;
}

/// Lists the things that lie within reach of another object, group by group.
void ClassBridging::sortByGroup(const ThingScan& scan, const ClassTable& table,
                                const std::vector<RefinedObject>& objects,
                                const std::vector<std::uint32_t>& object_of_thing)
{
  things_of_group_.resize(table.groupCount());
  for (auto& things : things_of_group_) things.clear();
  for (std::uint32_t i = 0; i < scan.size(); ++i)
  {
    const std::uint32_t object = object_of_thing[i];
    if (reach_[object].contains(scan.points[i].x, scan.points[i].y))
      things_of_group_[table[objects[object].class_index].group].push_back(i);
  }
}

void ClassBridging::uniteClose(const ThingScan& scan, const std::vector<std::uint32_t>& things, float distance,
                               const std::vector<std::uint32_t>& object_of_thing)
{
  cells_.clear(distance);
  for (const std::uint32_t i : things) cells_.add(scan.points[i].x, scan.points[i].y, i);
  cells_.close();
  cells_.link(distance);
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
  {
    const std::uint32_t whole = object_of_thing[cells_.firstThing(cells_.components()[cell])];
    cells_.forEach(cell, [&](std::uint32_t thing) { sets_.unite(object_of_thing[thing], whole); });
  }
}
}  // namespace lidar_panoptic_clustering
