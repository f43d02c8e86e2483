#include "lidar_panoptic_clustering/refinement/part_merging.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kCellM = 4.0F;       // about a car's length: most objects lie in one to four cells
constexpr float kGapInLinks = 2.0F;  // times the class's link distance
constexpr float kSlack = 1.3F;       // on the usual size, of parts that lie within the link distance
constexpr float kRounding = 1.001F;  // the outlines' extents are never to exclude what their gap would not
constexpr int kMostNeighbours = 64, kFewestNeighbours = 4;
constexpr int kManyPairs = 1 << 18;  // 64 neighbours for as many objects as no street has
constexpr int kMostCells = 256;      // an outline that covers more fits no class

/// Whether two outlines that far apart can be one object of the class.
bool fit(const Footprint& a, const Footprint& b, const ClassInfo& info, float squared_gap)
{
  const float link = info.link_distance_m, reach = kGapInLinks * link;
  if (squared_gap >= reach * reach) return false;
  const float slack = squared_gap < link * link ? kSlack : 1.0F;
  Footprint both = a;
  both.add(b);
  return both.fits(slack * info.length_m, slack * info.width_m);
}

int neighboursOf(std::size_t objects)
{
  return std::clamp(kManyPairs / static_cast<int>(objects + 1), kFewestNeighbours, kMostNeighbours);
}

std::int32_t cellOf(float metres)
{
  return static_cast<std::int32_t>(std::floor(metres / kCellM));
}
}  // namespace

template <class Visit>
void PartMerger::visitCells(float min_x, float max_x, float min_y, float max_y, const Visit& visit) const
{
  const std::int32_t columns = cellOf(max_x) - cellOf(min_x) + 1, rows = cellOf(max_y) - cellOf(min_y) + 1;
  if (columns > kMostCells || rows > kMostCells || columns * rows > kMostCells) return;
  for (std::int32_t row = 0; row < rows; ++row)
    for (std::int32_t column = 0; column < columns; ++column)
      visit(VoxelKey{cellOf(min_x) + column, cellOf(min_y) + row, 0});
}

void PartMerger::fillGrid(const std::vector<RefinedObject>& objects)
{
  const auto visitAll = [&](const auto& visit)
  {
    for (std::uint32_t i = 0; i < objects.size(); ++i)
    {
      const Footprint& f = objects[i].footprint;
      visitCells(f.minX(), f.maxX(), f.minY(), f.maxY(), [&](const VoxelKey& key) { visit(i, key); });
    }
  };
  std::size_t count = 0;
  visitAll([&](std::uint32_t, const VoxelKey&) { ++count; });
  grid_.reset(count);
  first_.clear();
  entries_.clear();
  visitAll(
      [&](std::uint32_t object, const VoxelKey& key)
      {
        const std::uint32_t cell = grid_.insert(key);
        if (cell == first_.size()) first_.push_back(kNone);
        entries_.push_back({object, first_[cell]});
        first_[cell] = static_cast<std::uint32_t>(entries_.size() - 1);
      });
}

void PartMerger::collectPairs(const std::vector<RefinedObject>& objects, const ClassTable& table)
{
  pairs_.clear();
  seen_.assign(objects.size(), kNone);
  const int most_neighbours = neighboursOf(objects.size());
  for (std::uint32_t a = 0; a < objects.size(); ++a)
  {
    const ClassInfo& info = table[objects[a].class_index];
    const Footprint& mine = objects[a].footprint;
    const float reach = kGapInLinks * info.link_distance_m;
    int left = most_neighbours;
    visitCells(mine.minX() - reach, mine.maxX() + reach, mine.minY() - reach, mine.maxY() + reach,
               [&](const VoxelKey& key)
               {
                 const std::uint32_t cell = grid_.find(key);
                 if (cell == VoxelIndex::kNone) return;
                 for (std::uint32_t e = first_[cell]; e != kNone && left > 0; e = entries_[e].next)
                 {
                   const std::uint32_t b = entries_[e].object;
                   if (b >= a || seen_[b] == a || objects[b].class_index != objects[a].class_index) continue;
                   seen_[b] = a;
                   --left;
                   if (!mine.mayBeCloser(objects[b].footprint, kRounding * reach)) continue;
                   const Footprint::Gap gap = mine.gapTo(objects[b].footprint);
                   if (fit(mine, objects[b].footprint, info, gap.squaredDistance()) && !isParted(objects, a, b, gap))
                     pairs_.push_back({gap.squaredDistance(), b, a});
                 }
               });
  }
  std::sort(pairs_.begin(), pairs_.end(),
            [](const Pair& p, const Pair& q)
            { return std::tie(p.squared_gap, p.a, p.b) < std::tie(q.squared_gap, q.a, q.b); });
}

bool PartMerger::isParted(const std::vector<RefinedObject>& objects, std::uint32_t a, std::uint32_t b,
                          const Footprint::Gap& gap) const
{
  if (gap.squaredDistance() == 0.0F) return false;
  bool parted = false;
  visitCells(std::min(gap.from.x, gap.to.x), std::max(gap.from.x, gap.to.x), std::min(gap.from.y, gap.to.y),
             std::max(gap.from.y, gap.to.y),
             [&](const VoxelKey& key)
             {
               const std::uint32_t cell = grid_.find(key);
               if (cell == VoxelIndex::kNone) return;
               int left = neighboursOf(objects.size());
               for (std::uint32_t e = first_[cell]; e != kNone && !parted && left > 0; e = entries_[e].next, --left)
               {
                 const std::uint32_t c = entries_[e].object;
                 parted = c != a && c != b && objects[c].footprint.isCrossedBy(gap.from, gap.to);
               }
             });
  return parted;
}

void PartMerger::sortObjects(const std::vector<RefinedObject>& objects)
{
  const auto place = [&objects](std::uint32_t i)
  {
    const RefinedObject& o = objects[i];
    return std::make_tuple(o.footprint.maxX(), o.footprint.maxY(), o.point_count, i);
  };
  // these are looked at only where the corner is the same
  by_min_x_.clear();
  for (std::uint32_t i = 0; i < objects.size(); ++i)
    by_min_x_.push_back({objects[i].footprint.minX(), objects[i].footprint.minY(), i});
  std::sort(by_min_x_.begin(), by_min_x_.end(),
            [&place](const Start& a, const Start& b)
            {
              if (a.min_x != b.min_x) return a.min_x < b.min_x;
              return a.min_y != b.min_y ? a.min_y < b.min_y : place(a.object) < place(b.object);
            });
  order_.clear();
  for (const Start& start : by_min_x_) order_.push_back(start.object);
  sorted_.clear();
  constexpr std::size_t kAhead = 16, kLine = 64;  // [bytes] of the cache; objects lie anywhere
  for (std::size_t k = 0; k < order_.size(); ++k)
  {
    if (k + kAhead < order_.size())
    {
      const auto* next = reinterpret_cast<const char*>(&objects[order_[k + kAhead]]);
      __builtin_prefetch(next), __builtin_prefetch(next + kLine);
    }
    sorted_.push_back(objects[order_[k]]);
  }
}

void PartMerger::merge(const std::vector<RefinedObject>& objects, const ClassTable& table,
                       std::vector<std::uint32_t>& whole_of)
{
  sortObjects(objects);
  fillGrid(sorted_);
  collectPairs(sorted_, table);
  sets_.reset(sorted_.size());
  for (const Pair& pair : pairs_)
  {
    const std::uint32_t a = sets_.find(pair.a), b = sets_.find(pair.b);
    const ClassInfo& info = table[sorted_[a].class_index];
    if (a == b || !fit(sorted_[a].footprint, sorted_[b].footprint, info, pair.squared_gap)) continue;
    sets_.unite(a, b);
    sorted_[std::min(a, b)].footprint.add(sorted_[std::max(a, b)].footprint);
  }
  whole_of.resize(objects.size());
  for (std::uint32_t i = 0; i < sorted_.size(); ++i) whole_of[order_[i]] = order_[sets_.find(i)];
}
}  // namespace lidar_panoptic_clustering
