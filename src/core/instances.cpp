#include "lidar_panoptic_clustering/core/instances.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kNone = 0xFFFFFFFF;
}  // namespace

Refinement::Refinement(std::shared_ptr<const ClassTable> table, const RefinementConfig& config)
    : table_(std::move(table)), config_(config)
{
  validateParameters(config_);
}

void Refinement::refine(const ThingScan& scan, const std::vector<std::uint32_t>& component, Instances& instances)
{
  gather(scan, component);
  if (config_.bridge_distance_m > 0.0) bridge(scan);
  if (config_.split) splitTooBig(scan);
  if (config_.merge)
  {
    merger_.merge(objects_, *table_, whole_of_);
  }
  else
  {
    whole_of_.resize(objects_.size());
    std::iota(whole_of_.begin(), whole_of_.end(), 0U);
  }
  number(scan, instances);
}

/// Makes an object of each part that occurs, numbered by first point; a part is any number below the scan's size.
void Refinement::gather(const ThingScan& scan, const std::vector<std::uint32_t>& part_of_thing)
{
  object_of_part_.assign(scan.size(), kNone);
  object_of_thing_.resize(scan.size());
  objects_.clear();
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    std::uint32_t& object = object_of_part_[part_of_thing[i]];
    if (object == kNone)
    {
      object = static_cast<std::uint32_t>(objects_.size());
      objects_.emplace_back();
    }
    object_of_thing_[i] = object;
    ++objects_[object].point_count;
    objects_[object].footprint.add(scan.points[i].x, scan.points[i].y);
  }

  votes_.assign(objects_.size() * scan.class_count, 0);
  for (std::size_t i = 0; i < scan.size(); ++i) ++votes_[object_of_thing_[i] * scan.class_count + scan.class_index[i]];
  for (std::size_t k = 0; k < objects_.size(); ++k)
  {
    const auto begin = votes_.begin() + static_cast<std::ptrdiff_t>(k * scan.class_count);
    objects_[k].class_index = static_cast<ClassIndex>(std::max_element(begin, begin + scan.class_count) - begin);
  }
}

void Refinement::bridge(const ThingScan& scan)
{
  bridging_.join(scan, *table_, static_cast<float>(config_.bridge_distance_m), objects_, object_of_thing_, whole_of_);
  bool joined = false;
  for (std::uint32_t k = 0; k < whole_of_.size(); ++k) joined = joined || whole_of_[k] != k;
  if (!joined) return;
  std::vector<std::uint32_t>& part = size_of_;  // free until number()
  part.resize(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) part[i] = whole_of_[object_of_thing_[i]];
  gather(scan, part);
}

bool Refinement::isTooBig(const RefinedObject& object) const
{
  const ClassInfo& info = (*table_)[object.class_index];
  const auto margin = static_cast<float>(config_.size_margin);
  return !object.footprint.fits(margin * info.length_m, margin * info.width_m);
}

void Refinement::splitTooBig(const ThingScan& scan)
{
  std::vector<Things> too_big;
  std::vector<std::uint32_t> place(objects_.size(), kNone);
  for (std::uint32_t k = 0; k < objects_.size(); ++k)
  {
    if (!isTooBig(objects_[k])) continue;
    place[k] = static_cast<std::uint32_t>(too_big.size());
    too_big.emplace_back();
  }
  if (too_big.empty()) return;
  for (std::uint32_t i = 0; i < scan.size(); ++i)
    if (place[object_of_thing_[i]] != kNone) too_big[place[object_of_thing_[i]]].push_back(i);
  for (const Things& things : too_big) split(scan, things);
}

/// Splits an object and what comes of it until all fits or hangs together.
void Refinement::split(const ThingScan& scan, const Things& whole)
{
  std::vector<Things> open = {whole};
  std::vector<std::uint32_t> part;
  while (!open.empty())
  {
    const Things things = std::move(open.back());
    open.pop_back();
    const std::uint32_t object = object_of_thing_[things[0]];
    if (!isTooBig(objects_[object])) continue;
    const std::uint32_t parts =
        splitter_.split(scan, things, scan.class_link_distance[objects_[object].class_index], part);
    if (parts < 2) continue;
    std::vector<Things> things_of(parts);
    for (std::size_t k = 0; k < things.size(); ++k) things_of[part[k]].push_back(things[k]);
    for (std::uint32_t p = 0; p < parts; ++p)
    {
      const std::uint32_t fresh = p == 0 ? object : static_cast<std::uint32_t>(objects_.size());
      if (p > 0) objects_.emplace_back();
      for (const std::uint32_t i : things_of[p]) object_of_thing_[i] = fresh;
      measure(scan, things_of[p], objects_[fresh]);
      open.push_back(std::move(things_of[p]));
    }
  }
}

/// Size, outline and class of the object that consists of `things`.
void Refinement::measure(const ThingScan& scan, const Things& things, RefinedObject& object)
{
  object = RefinedObject();
  votes_.assign(scan.class_count, 0);
  for (const std::uint32_t i : things)
  {
    object.footprint.add(scan.points[i].x, scan.points[i].y);
    ++votes_[scan.class_index[i]];
  }
  object.point_count = static_cast<std::uint32_t>(things.size());
  object.class_index = static_cast<ClassIndex>(std::max_element(votes_.begin(), votes_.end()) - votes_.begin());
}

/// Ids by first pixel for the wholes that are large enough.
void Refinement::number(const ThingScan& scan, Instances& instances)
{
  size_of_.assign(objects_.size(), 0);
  for (std::size_t k = 0; k < objects_.size(); ++k) size_of_[whole_of_[k]] += objects_[k].point_count;
  id_of_.assign(objects_.size(), 0);
  instances.id.resize(scan.size());
  instances.objects.clear();
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    const std::uint32_t whole = whole_of_[object_of_thing_[i]];
    if (id_of_[whole] == 0 && size_of_[whole] >= static_cast<std::uint32_t>(config_.min_points))
    {
      instances.objects.push_back({size_of_[whole], objects_[whole].class_index, 0.0F, 0.0F, 0.0F});
      id_of_[whole] = static_cast<std::uint32_t>(instances.objects.size());
    }
    const std::uint32_t id = instances.id[i] = id_of_[whole];
    if (id == 0) continue;
    auto& object = instances.objects[id - 1];
    object.x += scan.points[i].x, object.y += scan.points[i].y, object.z += scan.points[i].z;
  }
  for (auto& object : instances.objects)
  {
    const float scale = 1.0F / static_cast<float>(object.point_count);
    object.x *= scale, object.y *= scale, object.z *= scale;
  }
}
}  // namespace lidar_panoptic_clustering
