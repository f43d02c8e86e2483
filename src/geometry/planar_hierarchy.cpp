#include "lidar_panoptic_clustering/geometry/planar_hierarchy.h"

#include "geometry/z_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kSideInDiagonals = 0.7071F;  // below sqrt(1/2): two points of a cell are closer than its diagonal
constexpr float kRounding = 1.0001F;         // no block is to be passed over that holds a close point
constexpr std::size_t kManyPoints = 2;       // a cell, in the mean: comparing cells takes its time
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
  looked_at_ = 0;
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
    entry_sort_.sort(entries_, bits, [](std::uint64_t entry) { return entry >> 32U; });
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
    if (kManyPoints * size() < added_.size())
    {
      linkTiles(level, 1, distance);  // first, so that most pairs farther apart are joined before their turn
      sets_.flatten(component_);
    }
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
  const float sides = kRounding * distance * cells_per_m_ / static_cast<float>(1 << level);
  for (int rows = 0; rows <= reach; ++rows)
  {
    const float up = static_cast<float>(std::max(0, rows - 1));  // rows between the blocks
    reach_of_row_[rows] = std::min(reach, 1 + static_cast<int>(std::sqrt(std::max(0.0F, sides * sides - up * up))));
  }
  in_window_ = nullptr;
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
    Window& window = windowAt(row + at.y, column + at.x);
    window.block.begin = cell;
    window.component = component_[cell];
    const PlanarSample* const first = cells_.begin(cell);
    window.x = first->x, window.y = first->y;
    cell += level == 0 ? 1U : kBitCounts.of[occupied & 255U] + kBitCounts.of[occupied >> 8U];
    window.block.end = cell;
    window.is_one = first + 1 == cells_.end(cell - 1);
  }
  for (int y = 0; y < kSide >> level; ++y) rows_[row + y] |= static_cast<std::uint32_t>(tile.rows[level][y]) << column;
}

/// Lays the window about a tile. Where it was about the one left of it, only the tiles on the right are new.
void PlanarHierarchy::moveWindow(const Tile& tile, int level)
{
  const int side = kSide >> level;
  const auto take = [&](std::uint32_t other, int row, int column)
  {
    if (other != kNone) lookAt(tiles_[other], level, row * side, column * side);
  };
  if (in_window_ != nullptr && in_window_ + 1 == &tile && in_window_->place + 1 == tile.place)
  {
    window_begin_ = (window_begin_ + static_cast<std::uint32_t>(side)) % kWindow;
    for (std::uint32_t& row : rows_) row >>= side;
    for (int y = 0; y < side; ++y) rows_[y] &= ~0U << side;  // what is on the left looks here
  }
  else
  {
    std::fill(std::begin(rows_), std::end(rows_), 0U);
    lookAt(tile, level, 0, side);
    take(tile.beside[1], 1, 0);
    take(tile.beside[2], 1, 1);
  }
  take(tile.beside[0], 0, 2);
  take(tile.beside[3], 1, 2);
  in_window_ = &tile;
}

/// Joins each block of the tile with those after it in the tile, those of the tile right of it and those of the tiles
/// above: half of all, the other half looks here.
void PlanarHierarchy::linkTile(const Tile& tile, int level, int reach, float distance)
{
  moveWindow(tile, level);
  const int side = kSide >> level;
  for (int y = 0; y < side; ++y)
    for (unsigned mine = tile.rows[level][y]; mine != 0; mine &= mine - 1U)
    {
      const int x = side + __builtin_ctz(mine);
      const Window& from = windowAt(y, x);
      for (int row = std::max(0, y - reach); row <= y + reach; ++row)
      {
        // below: only the tile on the right; beside: only what is right of it
        const int first = row < y ? 2 * side : row == y ? x + 1 : 0;
        const int columns = reach_of_row_[std::abs(row - y)];
        const std::uint32_t window = ((2U << (2 * columns)) - 1U) << (x - columns);
        std::uint32_t others = rows_[row] & window & ~0U << first;
        for (; others != 0; others &= others - 1U) linkBlocks(from, windowAt(row, __builtin_ctz(others)), distance);
      }
    }
}

/// Joins two blocks that hold points closer than `distance`.
inline void PlanarHierarchy::linkBlocks(const Window& from, const Window& to, float distance)
{
  if (from.component == to.component) return;
  const std::uint32_t a = from.block.begin, b = to.block.begin;
  if (from.is_one && to.is_one)
  {
    looked_at_ += 2;
    const float dx = from.x - to.x, dy = from.y - to.y;
    if (dx * dx + dy * dy < distance * distance) sets_.unite(a, b);
  }
  else if (sets_.find(a) != sets_.find(b) && cells_.areCloser(from.block, to.block, distance))
  {
    sets_.unite(a, b);
  }
}
}  // namespace lidar_panoptic_clustering
