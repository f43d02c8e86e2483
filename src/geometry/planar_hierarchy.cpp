#include "lidar_panoptic_clustering/geometry/planar_hierarchy.h"

#include "geometry/z_curve.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kSideInDiagonals = 0.7071F;  // below sqrt(1/2): two points of a cell are closer than its diagonal
constexpr std::size_t kFew = 48;             // points that are sorted faster by comparison

/// std::floor is a call to the C library on processors without SSE 4.1.
std::int32_t floorToInt(float value)
{
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (value < static_cast<float>(truncated) ? 1 : 0);
}

int widthOf(std::uint64_t value)
{
  return value == 0 ? 1 : 64 - __builtin_clzll(value);
}
}  // namespace

void PlanarHierarchy::clear(float distance)
{
  distance_ = distance;
  cells_per_m_ = 1.0F / (kSideInDiagonals * distance);
  added_.clear();
  level_ = -1;
}

void PlanarHierarchy::close()
{
  tiles_.clear();
  component_.clear();
  cells_.clear(added_.size());
  cell_of_added_.resize(added_.size());
  placed_ = 0;
  if (!added_.empty()) sortIntoCells();
  closeTiles();
  cells_.close();
  findNeighbours();
}

/// Lays the grid over the points and makes runs of those that lie in one cell one after the other, as neighbours on a
/// scan line mostly do; sorts these.
void PlanarHierarchy::sortIntoCells()
{
  float min_x = added_[0].x, max_x = min_x, min_y = added_[0].y, max_y = min_y;
  for (const PlanarSample& p : added_)
  {
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
  }
  const std::int32_t origin_x = floorToInt(min_x * cells_per_m_), origin_y = floorToInt(min_y * cells_per_m_);
  stride_ = (static_cast<std::uint64_t>(floorToInt(max_x * cells_per_m_) - origin_x) >> 3U) + 2;
  const std::uint64_t rows = (static_cast<std::uint64_t>(floorToInt(max_y * cells_per_m_) - origin_y) >> 3U) + 1;

  runs_.clear();
  std::uint32_t last_x = 0, last_y = 0;
  const auto count = static_cast<std::uint32_t>(added_.size());
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const auto x = static_cast<std::uint32_t>(floorToInt(added_[k].x * cells_per_m_) - origin_x);
    const auto y = static_cast<std::uint32_t>(floorToInt(added_[k].y * cells_per_m_) - origin_y);
    if (k > 0 && x == last_x && y == last_y) continue;
    last_x = x, last_y = y;
    runs_.push_back({((y >> 3U) * stride_ + (x >> 3U)) << 6U | alongCurve(x & 7U, y & 7U), k});
  }
  const auto run_count = static_cast<std::uint32_t>(runs_.size());
  runs_.push_back({0, count});

  const int bits = widthOf(rows * stride_ - 1) + 6;
  if (bits > 32)
  {
    order_.resize(run_count);
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(),
              [this](std::uint32_t a, std::uint32_t b)
              { return runs_[a].key != runs_[b].key ? runs_[a].key < runs_[b].key : a < b; });
    for (const std::uint32_t run : order_) placeRun(run);
    return;
  }
  entries_.resize(run_count);
  for (std::uint32_t run = 0; run < run_count; ++run) entries_[run] = runs_[run].key << 32U | run;
  if (run_count <= kFew)
    std::sort(entries_.begin(), entries_.end());
  else
    sortBySteps(bits);
  constexpr std::size_t kAhead = 12;  // the points lie anywhere: their way into the cache begins that many runs before
  for (std::size_t k = 0; k < entries_.size(); ++k)
  {
    if (k + 2 * kAhead < entries_.size())
      __builtin_prefetch(&runs_[static_cast<std::uint32_t>(entries_[k + 2 * kAhead])]);
    if (k + kAhead < entries_.size())
    {
      const std::uint32_t begin = runs_[static_cast<std::uint32_t>(entries_[k + kAhead])].begin;
      __builtin_prefetch(&added_[begin]);
      __builtin_prefetch(&cell_of_added_[begin], 1);
    }
    placeRun(static_cast<std::uint32_t>(entries_[k]));
  }
}

/// Sorts entries_ by the `bits` from bit 32 on, a digit after the other; what is equal keeps its order.
void PlanarHierarchy::sortBySteps(int bits)
{
  const int widest = std::clamp(widthOf(entries_.size()), 6, 11);
  const int steps = (bits + widest - 1) / widest, digit = (bits + steps - 1) / steps;
  const std::uint64_t mask = (std::uint64_t{1} << digit) - 1;
  entries_aside_.resize(entries_.size());
  for (int step = 0, shift = 32; step < steps; ++step, shift += digit)
  {
    counts_.assign(mask + 1, 0);
    for (const std::uint64_t entry : entries_) ++counts_[entry >> shift & mask];
    std::uint32_t begin = 0;
    for (std::uint32_t& count : counts_) begin += std::exchange(count, begin);
    for (const std::uint64_t entry : entries_) entries_aside_[counts_[entry >> shift & mask]++] = entry;
    entries_.swap(entries_aside_);
  }
}

/// Takes over the points of the next run in order of keys.
inline void PlanarHierarchy::placeRun(std::uint32_t run)
{
  const std::uint64_t key = runs_[run].key;
  if (placed_ == 0 || key != last_key_)
  {
    if (placed_ == 0 || key >> 6U != last_key_ >> 6U)
    {
      Tile& tile = tiles_.emplace_back();
      tile.place = key >> 6U;
      tile.first_cell = cells_.size();
      tile_at_ = {static_cast<std::int32_t>(tile.place % stride_) * kSide,
                  static_cast<std::int32_t>(tile.place / stride_) * kSide};
    }
    last_key_ = key;
    Tile& tile = tiles_.back();
    tile.occupied |= std::uint64_t{1} << (key & 63U);
    const CurvePlace at = kCurve.of[key & 63U];
    tile.rows[0][at.y] = static_cast<std::uint8_t>(tile.rows[0][at.y] | 1U << at.x);
    cells_.addCell(placed_, {tile_at_.x + at.x, tile_at_.y + at.y});
  }
  const std::uint32_t begin = runs_[run].begin, end = runs_[run + 1].begin, cell = cells_.size() - 1;
  PlanarSample* const points = cells_.points().data();
  for (std::uint32_t k = begin; k < end; ++k)
  {
    points[placed_++] = added_[k];
    cell_of_added_[k] = cell;
  }
}

void PlanarHierarchy::closeTiles()
{
  for (Tile& tile : tiles_)
    for (int level = 1; level < kLevels; ++level)
      for (int y = 0; y < kSide >> level; ++y)
      {
        const unsigned both = tile.rows[level - 1][2 * y] | tile.rows[level - 1][2 * y + 1];
        for (int x = 0; x < kSide >> level; ++x)
          if ((both >> (2 * x) & 3U) != 0)
            tile.rows[level][y] = static_cast<std::uint8_t>(tile.rows[level][y] | 1U << x);
      }
}

/// One sweep over all rows with a finger in the row above.
void PlanarHierarchy::findNeighbours()
{
  std::size_t finger = 0;
  for (std::size_t i = 0; i < tiles_.size(); ++i)
  {
    Tile& tile = tiles_[i];
    tile.beside.fill(kNone);
    if (i + 1 < tiles_.size() && tiles_[i + 1].place == tile.place + 1)
      tile.beside[0] = static_cast<std::uint32_t>(i + 1);
    const std::uint64_t first = tile.place + stride_ - 1;
    while (finger < tiles_.size() && tiles_[finger].place < first) ++finger;
    for (std::size_t n = finger; n < tiles_.size() && tiles_[n].place <= first + 2; ++n)
      tile.beside[1 + tiles_[n].place - first] = static_cast<std::uint32_t>(n);
  }
}

void PlanarHierarchy::link(float distance)
{
  int level = 0;
  while (level + 1 < kLevels && static_cast<float>(2 << level) * distance_ <= distance) ++level;
  const float sides = distance * cells_per_m_ / static_cast<float>(1 << level);
  const int reach = static_cast<int>(sides) + 1;
  if (distance < distance_ || reach > std::min(3, kSide >> level))
    throw std::invalid_argument("cells of that size are linked at their diagonal to five times as much");
  if (level_ < 0)
  {
    sets_.reset(size());
    if (level > 0) uniteBlocks(level);
    sets_.flatten(component_);
    uniform_.assign(tiles_.size(), kNone);
    linkTiles(level, 1, distance);  // first, so that most pairs farther apart are joined before their turn
    sets_.flatten(component_);
  }
  else if (level > level_)
  {
    uniteBlocks(level);
    sets_.flatten(component_);
  }
  level_ = level;
  linkTiles(level, reach, distance);
  sets_.flatten(component_);
}

/// Joins the cells of each block.
void PlanarHierarchy::uniteBlocks(int level)
{
  for (std::uint32_t cell = 1; cell < size(); ++cell)
  {
    const CellContents::Place &a = cells_.place(cell - 1), &b = cells_.place(cell);
    if (a.x >> level == b.x >> level && a.y >> level == b.y >> level) sets_.unite(cell - 1, cell);
  }
}

void PlanarHierarchy::findUniform()
{
  for (std::size_t i = 0; i < tiles_.size(); ++i)
  {
    const std::uint32_t first = tiles_[i].first_cell, end = i + 1 < tiles_.size() ? tiles_[i + 1].first_cell : size();
    if (uniform_[i] != kNone)
    {
      uniform_[i] = component_[first];
      continue;
    }
    std::uint32_t cell = first;
    while (cell < end && component_[cell] == component_[first]) ++cell;
    if (cell == end) uniform_[i] = component_[first];
  }
}

/// Whether nothing in or beside the tile can be joined any more.
bool PlanarHierarchy::isSettled(const Tile& tile) const
{
  const std::uint32_t mine = uniform_[static_cast<std::size_t>(&tile - tiles_.data())];
  if (mine == kNone) return false;
  for (const std::uint32_t other : tile.beside)
    if (other != kNone && uniform_[other] != mine) return false;
  return true;
}

void PlanarHierarchy::linkTiles(int level, int reach, float distance)
{
  findUniform();
  for (const Tile& tile : tiles_)
    if (!isSettled(tile)) linkTile(tile, level, reach, distance);
}

/// Notes the blocks of a tile in the window, whose bottom left tile is at row and column 0.
void PlanarHierarchy::lookAt(const Tile& tile, int level, int row, int column)
{
  std::uint32_t cell = tile.first_cell;
  const int cells = 1 << (2 * level);
  const std::uint64_t mask = (std::uint64_t{1} << cells) - 1;
  for (std::uint64_t left = tile.occupied; left != 0;)
  {
    const int block = __builtin_ctzll(left) >> (2 * level);
    const std::uint64_t occupied = left >> (block * cells) & mask;
    left &= ~(mask << (block * cells));
    const CurvePlace at = kCurve.of[block];
    Window& window = window_[row + at.y][column + at.x];
    window.block.begin = cell;
    window.component = component_[cell];
    cell += level == 0 ? 1U : kBitCounts.of[occupied & 255U] + kBitCounts.of[occupied >> 8U];
    window.block.end = cell;
  }
}

/// Joins each block of the tile with those after it in the tile, those of the tile right of it and those of the tiles
/// above: half of all, the other half looks here.
void PlanarHierarchy::linkTile(const Tile& tile, int level, int reach, float distance)
{
  const int side = kSide >> level;
  std::uint32_t rows[2 * kSide] = {};  // a bit an occupied block
  const auto take = [&](const Tile& other, int row, int column)
  {
    lookAt(other, level, row * side, column * side);
    for (int y = 0; y < side; ++y)
      rows[row * side + y] |= static_cast<std::uint32_t>(other.rows[level][y]) << (column * side);
  };
  take(tile, 0, 1);
  if (tile.beside[0] != kNone) take(tiles_[tile.beside[0]], 0, 2);
  for (int k = 0; k < 3; ++k)
    if (tile.beside[1 + k] != kNone) take(tiles_[tile.beside[1 + k]], 1, k);

  const std::uint32_t window = (2U << (2 * reach)) - 1U;
  for (int y = 0; y < side; ++y)
    for (unsigned mine = tile.rows[level][y]; mine != 0; mine &= mine - 1U)
    {
      const int x = side + __builtin_ctz(mine);
      const Window& from = window_[y][x];
      for (int row = std::max(0, y - reach); row <= y + reach; ++row)
      {
        // below: only the tile on the right; beside: only what is right of it
        const int first = row < y ? 2 * side : row == y ? x + 1 : 0;
        std::uint32_t others = rows[row] & window << (x - reach) & ~0U << first;
        for (; others != 0; others &= others - 1U)
        {
          const Window& to = window_[row][__builtin_ctz(others)];
          if (from.component != to.component && sets_.find(from.block.begin) != sets_.find(to.block.begin) &&
              cells_.areCloser(from.block, to.block, distance))
            sets_.unite(from.block.begin, to.block.begin);
        }
      }
    }
}
}  // namespace lidar_panoptic_clustering
