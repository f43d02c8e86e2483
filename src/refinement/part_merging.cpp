#include "lidar_panoptic_clustering/refinement/part_merging.h"

#include <algorithm>
#include <tuple>
#include <utility>

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

/// How much larger than usual two parts that far apart may be together.
float slackOf(const ClassInfo& info, float squared_gap)
{
  return squared_gap < info.link_distance_m * info.link_distance_m ? kSlack : 1.0F;
}

/// Whether two outlines together fit the class.
bool fit(const Footprint& a, const Footprint& b, const ClassInfo& info, float slack)
{
  return a.fitsWith(b, slack * info.length_m, slack * info.width_m);
}

int neighboursOf(std::size_t objects)
{
  return std::clamp(kManyPairs / static_cast<int>(objects + 1), kFewestNeighbours, kMostNeighbours);
}

std::int32_t cellOf(float metres)
{
  const float cells = metres / kCellM;
  const auto truncated = static_cast<std::int32_t>(cells);
  return truncated - (cells < static_cast<float>(truncated) ? 1 : 0);  // std::floor is a call to the C library
}
}  // namespace

template <class Visit>
void PartMerger::visitCells(float min_x, float max_x, float min_y, float max_y, const Visit& visit) const
{
  const std::int32_t left = cellOf(min_x), bottom = cellOf(min_y);
  const std::int32_t columns = cellOf(max_x) - left + 1, rows = cellOf(max_y) - bottom + 1;
  if (columns > kMostCells || rows > kMostCells || columns * rows > kMostCells) return;
  for (std::int32_t row = 0; row < rows; ++row)
    for (std::int32_t column = 0; column < columns; ++column) visit(VoxelKey{left + column, bottom + row, 0});
}

/// Sorts the objects along x, and what is compared of them into the order of their places.
void PartMerger::sortObjects(const std::vector<RefinedObject>& objects)
{
  const auto place = [&objects](std::uint32_t i)
  {
    const RefinedObject& o = objects[i];
    return std::make_tuple(o.footprint.maxX(), o.footprint.maxY(), o.point_count, i);
  };
  by_min_x_.clear();
  for (std::uint32_t i = 0; i < objects.size(); ++i)
    by_min_x_.push_back({objects[i].footprint.minX(), objects[i].footprint.minY(), i});
  // the objects themselves are looked at only where the corner is the same
  start_sort_.sort(
      by_min_x_, [](const Start& start) { return start.min_x; },
      [&place](const Start& a, const Start& b)
      { return a.min_y != b.min_y ? a.min_y < b.min_y : place(a.object) < place(b.object); });
  order_.clear();
  outlines_.clear();
  class_of_.clear();
  constexpr std::size_t kAhead = 16, kLine = 64;  // [bytes] of the cache; objects lie anywhere
  for (std::size_t k = 0; k < by_min_x_.size(); ++k)
  {
    if (k + kAhead < by_min_x_.size())
    {
      const auto* next = reinterpret_cast<const char*>(&objects[by_min_x_[k + kAhead].object]);
      __builtin_prefetch(next), __builtin_prefetch(next + kLine);
    }
    const RefinedObject& object = objects[by_min_x_[k].object];
    order_.push_back(by_min_x_[k].object);
    outlines_.push_back(object.footprint);
    class_of_.push_back(object.class_index);
  }
}

/// Lists the objects of each cell.
void PartMerger::fillGrid()
{
  grid_.reset();
  cell_of_entry_.clear();
  first_entry_.clear();
  begin_.clear();
  for (const Footprint& f : outlines_)
  {
    first_entry_.push_back(static_cast<std::uint32_t>(cell_of_entry_.size()));
    visitCells(f.minX(), f.maxX(), f.minY(), f.maxY(),
               [this](const VoxelKey& key)
               {
                 const std::uint32_t cell = grid_.insert(key);
                 if (cell == begin_.size()) begin_.push_back(0);
                 ++begin_[cell];
                 cell_of_entry_.push_back(cell);
               });
  }
  first_entry_.push_back(static_cast<std::uint32_t>(cell_of_entry_.size()));
  std::uint32_t begin = 0;
  for (std::uint32_t& count : begin_) begin += std::exchange(count, begin);
  begin_.push_back(begin);
  filled_.assign(begin_.begin(), begin_.end() - 1);
  entries_.resize(cell_of_entry_.size());
  for (std::uint32_t object = 0; object < outlines_.size(); ++object)
    for (std::uint32_t e = first_entry_[object]; e < first_entry_[object + 1]; ++e)
      entries_[filled_[cell_of_entry_[e]]++] = object;
}

void PartMerger::collectPairs(const ClassTable& table)
{
  pairs_.clear();
  seen_.assign(outlines_.size(), kNone);
  filled_.assign(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t a = 0; a < outlines_.size(); ++a)
  {
    compareWithEarlier(a, table[class_of_[a]]);
    for (std::uint32_t e = first_entry_[a]; e < first_entry_[a + 1]; ++e) ++filled_[cell_of_entry_[e]];
  }
  pair_sort_.sort(
      pairs_, [](const Pair& pair) { return pair.squared_gap; },
      [](const Pair& p, const Pair& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
}

/// Notes the pairs of an object with those before it, which its cells are filled with so far; the last ones first.
void PartMerger::compareWithEarlier(std::uint32_t a, const ClassInfo& info)
{
  const Footprint& mine = outlines_[a];
  const float reach = kGapInLinks * info.link_distance_m;
  int left = neighboursOf(outlines_.size());
  visitCells(mine.minX() - reach, mine.maxX() + reach, mine.minY() - reach, mine.maxY() + reach,
             [&](const VoxelKey& key)
             {
               if (left == 0) return;
               const std::uint32_t cell = grid_.find(key);
               if (cell == VoxelIndex::kNone) return;
               for (std::uint32_t e = filled_[cell]; e > begin_[cell] && left > 0; --e)
               {
                 const std::uint32_t b = entries_[e - 1];
                 if (class_of_[b] != class_of_[a] || seen_[b] == a) continue;
                 seen_[b] = a;
                 --left;
                 if (!mine.mayBeCloser(outlines_[b], kRounding * reach) || !fit(mine, outlines_[b], info, kSlack))
                   continue;
                 const Footprint::Gap gap = mine.gapTo(outlines_[b]);
                 const float squared_gap = gap.squaredDistance(), slack = slackOf(info, squared_gap);
                 if (squared_gap < reach * reach && (slack == kSlack || fit(mine, outlines_[b], info, slack)) &&
                     !isParted(a, b, gap))
                   pairs_.push_back({squared_gap, b, a});
               }
             });
}

/// Whether a third object lies between the two.
bool PartMerger::isParted(std::uint32_t a, std::uint32_t b, const Footprint::Gap& gap) const
{
  if (gap.squaredDistance() == 0.0F) return false;
  bool parted = false;
  visitCells(std::min(gap.from.x, gap.to.x), std::max(gap.from.x, gap.to.x), std::min(gap.from.y, gap.to.y),
             std::max(gap.from.y, gap.to.y),
             [&](const VoxelKey& key)
             {
               const std::uint32_t cell = parted ? VoxelIndex::kNone : grid_.find(key);
               if (cell == VoxelIndex::kNone) return;
               int left = neighboursOf(outlines_.size());
               for (std::uint32_t e = begin_[cell + 1]; e > begin_[cell] && !parted && left > 0; --e, --left)
               {
                 const std::uint32_t c = entries_[e - 1];
                 parted = c != a && c != b && outlines_[c].isCrossedBy(gap.from, gap.to);
               }
             });
  return parted;
}

void PartMerger::merge(const std::vector<RefinedObject>& objects, const ClassTable& table,
                       std::vector<std::uint32_t>& whole_of)
{
  sortObjects(objects);
  fillGrid();
  collectPairs(table);
  sets_.reset(outlines_.size());
  for (const Pair& pair : pairs_)
  {
    const std::uint32_t a = sets_.find(pair.a), b = sets_.find(pair.b);
    const ClassInfo& info = table[class_of_[a]];
    if (a == b || !fit(outlines_[a], outlines_[b], info, slackOf(info, pair.squared_gap))) continue;
    sets_.unite(a, b);
    outlines_[std::min(a, b)].add(outlines_[std::max(a, b)]);
  }
  whole_of.resize(objects.size());
  for (std::uint32_t i = 0; i < order_.size(); ++i) whole_of[order_[i]] = order_[sets_.find(i)];
}
}  // namespace lidar_panoptic_clustering
