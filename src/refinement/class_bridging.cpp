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
constexpr std::size_t kFewPoints = 2;   // an object, in the mean: outlines would save nothing
constexpr std::size_t kAhead = 16;      // objects that are fetched before they are looked at
}  // namespace

const ClassBridging::Reach ClassBridging::kEverywhere = {-kFar, kFar, -kFar, kFar};

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
  if (distance > 0.0F && (lookAtAll(scan, objects) || findReaches(objects, table, kRounding * distance)))
  {
    sortByGroup(scan, table, objects, object_of_thing);
    for (const auto& things : things_of_group_)
      if (things.size() > 1) uniteClose(scan, things, distance, object_of_thing);
  }
  sets_.flatten(whole_of);
}

/// Where objects have hardly more than a point: whether all points are to be looked at.
bool ClassBridging::lookAtAll(const ThingScan& scan, const std::vector<RefinedObject>& objects)
{
  if (objects.size() < 2 || kFewPoints * objects.size() < scan.size()) return false;
  reach_.assign(objects.size(), kEverywhere);
  return true;
}

/// Sweeps over the objects along x. Returns whether any two of a group may be near.
bool ClassBridging::findReaches(const std::vector<RefinedObject>& objects, const ClassTable& table, float distance)
{
  reach_.assign(objects.size(), {kFar, -kFar, kFar, -kFar});
  by_min_x_.clear();
  for (std::uint32_t k = 0; k < objects.size(); ++k) by_min_x_.push_back({objects[k].footprint.minX(), k});
  start_sort_.sort(
      by_min_x_, [](const Start& start) { return start.min_x; }, [](const Start&, const Start&) { return false; });
  extents_.clear();
  for (std::size_t i = 0; i < by_min_x_.size(); ++i)
  {
    if (i + kAhead < by_min_x_.size()) __builtin_prefetch(&objects[by_min_x_[i + kAhead].object].footprint);
    const RefinedObject& object = objects[by_min_x_[i].object];
    const Footprint& f = object.footprint;
    extents_.push_back({f.maxX(), f.minY(), f.maxY(), table[object.class_index].group});
  }

  bool found = false;
  std::size_t pairs_left = kMostPairs * objects.size();
  for (std::size_t i = 0; i < by_min_x_.size(); ++i)
  {
    const Extent& mine = extents_[i];
    for (std::size_t j = i + 1; j < by_min_x_.size(); ++j)
    {
      if (by_min_x_[j].min_x - mine.max_x >= distance) break;
      if (pairs_left-- == 0)
      {
        reach_.assign(objects.size(), kEverywhere);
        return true;
      }
      if (!mine.mayBeCloser(extents_[j], distance)) continue;
      const RefinedObject &a = objects[by_min_x_[i].object], &b = objects[by_min_x_[j].object];
      if (!a.footprint.mayBeCloser(b.footprint, distance)) continue;
      reach_[by_min_x_[i].object].add(b.footprint, distance);
      reach_[by_min_x_[j].object].add(a.footprint, distance);
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
  group_of_.clear();
  for (const RefinedObject& object : objects) group_of_.push_back(table[object.class_index].group);
  things_of_group_.resize(table.groupCount());
  for (auto& things : things_of_group_) things.clear();
  for (std::uint32_t i = 0; i < scan.size(); ++i)
  {
    const std::uint32_t object = object_of_thing[i];
    if (reach_[object].contains(scan.points[i].x, scan.points[i].y)) things_of_group_[group_of_[object]].push_back(i);
  }
}

void ClassBridging::uniteClose(const ThingScan& scan, const std::vector<std::uint32_t>& things, float distance,
                               const std::vector<std::uint32_t>& object_of_thing)
{
  cells_.clear(distance);
  for (const std::uint32_t i : things) cells_.add(scan.points[i].x, scan.points[i].y, object_of_thing[i]);
  cells_.close();
  cells_.link(distance);
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
  {
    std::uint32_t last = cells_.firstThing(cells_.components()[cell]);
    cells_.forEach(cell,
                   [&](std::uint32_t object)
                   {
                     if (object != last) sets_.unite(object, last);
                     last = object;
                   });
  }
}
}  // namespace lidar_panoptic_clustering
