#include "lidar_panoptic_clustering/refinement/refinement.h"

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
  requireOffOrDistance("bridge_distance_m", config_.bridge_distance_m, 10.0);
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

/// Makes an object of each component, numbered by first point. Neighbours on a scan line mostly share theirs, so the
/// points are taken run by run.
void Refinement::gather(const ThingScan& scan, const std::vector<std::uint32_t>& component)
{
  const auto count = static_cast<std::uint32_t>(scan.size());
  findClasses(scan);
  object_of_component_.assign(count, kNone);
  object_of_thing_.resize(count);
  objects_.clear();
  votes_.clear();
  for (std::uint32_t begin = 0, end = 0; begin < count; begin = end)
  {
    while (end < count && component[end] == component[begin]) ++end;
    std::uint32_t& object = object_of_component_[component[begin]];
    if (object == kNone)
    {
      object = static_cast<std::uint32_t>(objects_.size());
      objects_.emplace_back();
      votes_.resize(votes_.size() + classes_.size(), 0);
    }
    std::fill(object_of_thing_.begin() + begin, object_of_thing_.begin() + end, object);
    addRun(scan, begin, end, objects_[object], votesOf(object));
  }
  for (std::uint32_t k = 0; k < objects_.size(); ++k) elect(k);
}

/// Lists the classes that occur in the scan: votes have a column for each.
void Refinement::findClasses(const ThingScan& scan)
{
  column_of_class_.assign(scan.class_count, 0);
  for (const ClassIndex c : scan.class_index) column_of_class_[c] = 1;
  classes_.clear();
  for (std::uint32_t c = 0; c < scan.class_count; ++c)
  {
    if (column_of_class_[c] == 0) continue;
    column_of_class_[c] = static_cast<std::uint32_t>(classes_.size());
    classes_.push_back(static_cast<ClassIndex>(c));
  }
}

void Refinement::addRun(const ThingScan& scan, std::uint32_t begin, std::uint32_t end, RefinedObject& object,
                        std::uint32_t* votes) const
{
  object.point_count += end - begin;
  float x = 0.0F, y = 0.0F, z = 0.0F;
  for (std::uint32_t i = begin; i < end; ++i)
  {
    const ThingPoint& p = scan.points[i];
    object.footprint.add(p.x, p.y);
    x += p.x, y += p.y, z += p.z;
  }
  if (classes_.size() == 1)
    votes[0] += end - begin;
  else
    for (std::uint32_t i = begin; i < end; ++i) ++votes[column_of_class_[scan.class_index[i]]];
  object.sum_x += x, object.sum_y += y, object.sum_z += z;
}

/// The object's class by its votes; the lower index wins a tie.
void Refinement::elect(std::uint32_t object)
{
  const std::uint32_t* votes = votesOf(object);
  objects_[object].class_index =
      classes_[static_cast<std::size_t>(std::max_element(votes, votes + classes_.size()) - votes)];
}

void Refinement::bridge(const ThingScan& scan)
{
  bridging_.join(scan, *table_, static_cast<float>(config_.bridge_distance_m), objects_, object_of_thing_, whole_of_);
  constexpr std::uint32_t kAhead = 16;  // wholes lie anywhere: their way into the cache begins that many objects before
  std::uint32_t wholes = 0;
  for (std::uint32_t k = 0; k < whole_of_.size(); ++k)
  {
    if (k + kAhead < whole_of_.size() && whole_of_[k + kAhead] < k)
      __builtin_prefetch(&objects_[whole_of_[whole_of_[k + kAhead]]], 1);
    const std::uint32_t whole = whole_of_[k];  // the first of its objects: never above k, and renumbered before
    whole_of_[k] = whole == k ? wholes++ : whole_of_[whole];
    moveInto(k, whole_of_[k], whole == k);
  }
  if (wholes == objects_.size()) return;
  objects_.resize(wholes);
  for (std::uint32_t k = 0; k < wholes; ++k) elect(k);
  for (std::uint32_t& object : object_of_thing_) object = whole_of_[object];
}

/// Adds object `from` to object `to` <= `from`, or puts it in its place where it is the first there.
void Refinement::moveInto(std::uint32_t from, std::uint32_t to, bool is_first)
{
  if (from == to) return;
  const std::uint32_t* votes = votesOf(from);
  std::uint32_t* sum = votesOf(to);
  if (is_first)
  {
    objects_[to] = objects_[from];
    std::copy(votes, votes + classes_.size(), sum);
    return;
  }
  objects_[to].add(objects_[from]);
  for (std::size_t c = 0; c < classes_.size(); ++c) sum[c] += votes[c];
}

bool Refinement::isTooBig(const RefinedObject& object) const
{
  const ClassInfo& info = (*table_)[object.class_index];
  const auto margin = static_cast<float>(config_.size_margin);
  return !object.footprint.fits(margin * info.length_m, margin * info.width_m);
}

void Refinement::splitTooBig(const ThingScan& scan)
{
  open_.clear();
  slot_of_.assign(objects_.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < objects_.size(); ++k)
  {
    if (!isTooBig(objects_[k])) continue;
    slot_of_[k] = static_cast<std::uint32_t>(open_.size());
    open_.push_back({k, count, count});
    count += objects_[k].point_count;
  }
  if (open_.empty()) return;
  things_.resize(count);
  for (std::uint32_t i = 0; i < scan.size(); ++i)
    if (const std::uint32_t slot = slot_of_[object_of_thing_[i]]; slot != kNone) things_[open_[slot].end++] = i;
  while (!open_.empty())
  {
    const Range range = open_.back();
    open_.pop_back();
    split(scan, range);
  }
}

/// Splits an object whose points are a range of things_, and its parts, until they fit or hang together.
void Refinement::split(const ThingScan& scan, Range range)
{
  const float reach = scan.class_link_distance[objects_[range.object].class_index];
  if (range.tenths < LinkageTree::kFinest) return;
  if (!splitter_.begin(scan, &things_[range.begin], range.end - range.begin, reach)) return;
  const auto first_fresh = static_cast<std::uint32_t>(objects_.size());
  const std::uint32_t leaves = splitter_.leaves().size();
  countLeafVotes(scan, range);
  leaves_.resize(leaves);
  std::iota(leaves_.begin(), leaves_.end(), 0U);
  object_of_leaf_.assign(leaves, range.object);
  other_reach_.clear();
  parts_.assign(1, {range.object, 0, leaves, range.tenths});
  while (!parts_.empty())
  {
    const Range part = parts_.back();
    parts_.pop_back();
    if (scan.class_link_distance[objects_[part.object].class_index] != reach)
      other_reach_.push_back(part);
    else
      splitPart(part);
  }
  if (objects_.size() == first_fresh) return;
  assignThings(scan, range);
  openAgain(range);
}

/// Votes leaf by leaf.
void Refinement::countLeafVotes(const ThingScan& scan, Range range)
{
  const LinkageTree& leaves = splitter_.leaves();
  leaf_votes_.assign(leaves.size() * classes_.size(), 0);
  const std::uint32_t *votes = votesOf(range.object), count = objects_[range.object].point_count;
  const auto only = static_cast<std::size_t>(std::find(votes, votes + classes_.size(), count) - votes);
  if (only < classes_.size())
  {
    for (std::uint32_t leaf = 0; leaf < leaves.size(); ++leaf)
      leaf_votes_[leaf * classes_.size() + only] = leaves.pointsOf(leaf);
    return;
  }
  for (std::uint32_t k = range.begin; k < range.end; ++k)
    ++leaf_votes_[leaves.leafOf(k - range.begin) * classes_.size() + column_of_class_[scan.class_index[things_[k]]]];
}

/// Splits what a range of leaves_ makes together; parts that are still too big are opened for the next turn.
void Refinement::splitPart(Range part)
{
  const std::uint32_t parts = splitter_.split(&leaves_[part.begin], part.end - part.begin, part.tenths, part_of_leaf_);
  if (parts < 2) return;
  const auto first_fresh = static_cast<std::uint32_t>(objects_.size());
  objects_.resize(objects_.size() + parts - 1);
  votes_.resize(objects_.size() * classes_.size());
  sorted_.resize(part.end - part.begin);
  std::uint32_t begin = 0;
  for (std::uint32_t k = 0; k < parts; ++k)
  {
    const std::uint32_t object = k == 0 ? part.object : first_fresh + k - 1;
    std::uint32_t end = begin;
    for (std::uint32_t i = part.begin; i < part.end; ++i)
      if (part_of_leaf_[i - part.begin] == k) sorted_[end++] = leaves_[i];
    fillFromLeaves(object, &sorted_[begin], end - begin);
    if (isTooBig(objects_[object])) parts_.push_back({object, part.begin + begin, part.begin + end, part.tenths - 1});
    begin = end;
  }
  std::copy(sorted_.begin(), sorted_.end(), leaves_.begin() + part.begin);
}

/// Makes an object of leaves, all but the sums of its points.
void Refinement::fillFromLeaves(std::uint32_t object, const std::uint32_t* leaves, std::uint32_t count)
{
  objects_[object] = RefinedObject();
  std::uint32_t* votes = votesOf(object);
  std::fill_n(votes, classes_.size(), 0U);
  OrderedFootprint outline;
  for (const std::uint32_t* leaf = leaves; leaf != leaves + count; ++leaf)
  {
    object_of_leaf_[*leaf] = object;
    outline.add(splitter_.outline(*leaf));
    objects_[object].point_count += splitter_.leaves().pointsOf(*leaf);
    for (std::size_t c = 0; c < classes_.size(); ++c) votes[c] += leaf_votes_[*leaf * classes_.size() + c];
  }
  objects_[object].footprint = outline.outline();
  elect(object);
}

/// Writes whose the points of a split object are now, and sums them up.
void Refinement::assignThings(const ThingScan& scan, Range range)
{
  for (std::uint32_t k = range.begin; k < range.end; ++k)
  {
    const std::uint32_t i = things_[k], object = object_of_leaf_[splitter_.leaves().leafOf(k - range.begin)];
    object_of_thing_[i] = object;
    RefinedObject& o = objects_[object];
    o.sum_x += scan.points[i].x, o.sum_y += scan.points[i].y, o.sum_z += scan.points[i].z;
  }
}

/// Opens the parts whose class, by vote, is one with another link distance: their linkage has to be found anew.
void Refinement::openAgain(Range range)
{
  for (const Range& part : other_reach_)
  {
    const auto begin = static_cast<std::uint32_t>(things_.size());
    for (std::uint32_t k = range.begin; k < range.end; ++k)
      if (object_of_thing_[things_[k]] == part.object) things_.push_back(things_[k]);
    open_.push_back({part.object, begin, static_cast<std::uint32_t>(things_.size()), part.tenths});
  }
}

/// Ids by first pixel for the wholes that are large enough.
void Refinement::number(const ThingScan& scan, Instances& instances)
{
  for (std::uint32_t k = 0; k < objects_.size(); ++k)
    if (whole_of_[k] != k) objects_[whole_of_[k]].addPoints(objects_[k]);
  id_of_.assign(objects_.size(), kNone);
  instances.id.resize(scan.size());
  instances.objects.clear();
  for (std::size_t i = 0; i < scan.size(); ++i)
  {
    const std::uint32_t whole = whole_of_[object_of_thing_[i]];
    if (id_of_[whole] == kNone) id_of_[whole] = numbered(objects_[whole], instances);
    instances.id[i] = id_of_[whole];
  }
}

/// The id of an object whose first pixel has come up.
std::uint32_t Refinement::numbered(const RefinedObject& object, Instances& instances) const
{
  if (object.point_count < static_cast<std::uint32_t>(config_.min_points)) return 0;
  const float scale = 1.0F / static_cast<float>(object.point_count);
  instances.objects.push_back(
      {object.point_count, object.class_index, scale * object.sum_x, scale * object.sum_y, scale * object.sum_z});
  return static_cast<std::uint32_t>(instances.objects.size());
}
}  // namespace lidar_panoptic_clustering
