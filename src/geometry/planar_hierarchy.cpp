#include "lidar_panoptic_clustering/geometry/planar_hierarchy.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kSideInDiagonals = 0.7071F;  // below sqrt(1/2): two points of a cell are closer than its diagonal
constexpr std::size_t kFew = 48;             // points that are sorted faster by comparison
constexpr std::uint32_t kSpread[8] = {0, 1, 4, 5, 16, 17, 20, 21};  // the bits of a number, every second one

constexpr std::uint8_t bitsOf(unsigned byte)
{
  return static_cast<std::uint8_t>(byte == 0 ? 0 : (byte & 1U) + bitsOf(byte >> 1U));
}
struct BitCounts
{
  std::uint8_t of[256];
};
constexpr BitCounts makeBitCounts()
{
  BitCounts counts{};
  for (unsigned byte = 0; byte < 256; ++byte) counts.of[byte] = bitsOf(byte);
  return counts;
}
constexpr BitCounts kBitCounts = makeBitCounts();

/// Place along the Z-curve of column x and row y < 8.
std::uint32_t alongCurve(std::uint32_t x, std::uint32_t y)
{
  return kSpread[x] | kSpread[y] << 1U;
}

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

void PlanarHierarchy::sortIntoCells()
{
  float min_x = added_[0].x, max_x = min_x, min_y = added_[0].y, max_y = min_y;
  for (const PlanarSample& p : added_)
  {
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
  }
  origin_x_ = floorToInt(min_x * cells_per_m_), origin_y_ = floorToInt(min_y * cells_per_m_);
  stride_ = (static_cast<std::uint64_t>(floorToInt(max_x * cells_per_m_) - origin_x_) >> 3U) + 2;
  const std::uint64_t rows = (static_cast<std::uint64_t>(floorToInt(max_y * cells_per_m_) - origin_y_) >> 3U) + 1;
  const auto keyOf = [this](const PlanarSample& p)
  {
    const auto x = static_cast<std::uint32_t>(floorToInt(p.x * cells_per_m_) - origin_x_);
    const auto y = static_cast<std::uint32_t>(floorToInt(p.y * cells_per_m_) - origin_y_);
    return ((y >> 3U) * stride_ + (x >> 3U)) << 6U | alongCurve(x & 7U, y & 7U);
  };
  const int bits = widthOf(rows * stride_ - 1) + 6;
  if (bits <= 32)
  {
    entries_.clear();
    for (std::size_t k = 0; k < added_.size(); ++k) entries_.push_back(keyOf(added_[k]) << 32U | k);
    if (entries_.size() <= kFew)
      std::sort(entries_.begin(), entries_.end());
    else
      sortBySteps(bits);
    for (const std::uint64_t entry : entries_) addPoint(entry >> 32U, static_cast<std::uint32_t>(entry));
    return;
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> wide;
  for (std::size_t k = 0; k < added_.size(); ++k) wide.emplace_back(keyOf(added_[k]), static_cast<std::uint32_t>(k));
  std::sort(wide.begin(), wide.end());
  for (const auto& [key, k] : wide) addPoint(key, k);
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

/// The next point in order of keys.
void PlanarHierarchy::addPoint(std::uint64_t key, std::uint32_t added)
{
  if (placed_ == 0 || key != last_key_)
  {
    if (placed_ == 0 || key >> 6U != last_key_ >> 6U)
    {
      Tile& tile = tiles_.emplace_back();
      tile.place = key >> 6U;
      tile.first_cell = cells_.size();
    }
    last_key_ = key;
    Tile& tile = tiles_.back();
    tile.occupied |= std::uint64_t{1} << (key & 63U);
    std::int32_t x = 0, y = 0;
    for (int bit = 0; bit < 3; ++bit)
    {
      x |= static_cast<std::int32_t>(key >> (2 * bit) & 1U) << bit;
      y |= static_cast<std::int32_t>(key >> (2 * bit + 1) & 1U) << bit;
    }
    tile.rows[0][y] = static_cast<std::uint8_t>(tile.rows[0][y] | 1U << x);
    cells_.addCell(placed_, {static_cast<std::int32_t>(tile.place % stride_) * kSide + x,
                             static_cast<std::int32_t>(tile.place / stride_) * kSide + y});
  }
  cells_.points()[placed_++] = added_[added];
  cell_of_added_[added] = cells_.size() - 1;
}

void PlanarHierarchy::closeTiles()
{
  for (Tile& tile : tiles_)
  {
    std::uint8_t before = 0;
    for (unsigned eighth = 0; eighth < kSide; ++eighth)
    {
      tile.rank[eighth] = before;
      before = static_cast<std::uint8_t>(before + kBitCounts.of[tile.occupied >> (8 * eighth) & 255U]);
    }
    for (int level = 1; level < kLevels; ++level)
      for (int y = 0; y < kSide >> level; ++y)
      {
        const unsigned both = tile.rows[level - 1][2 * y] | tile.rows[level - 1][2 * y + 1];
        for (int x = 0; x < kSide >> level; ++x)
          if ((both >> (2 * x) & 3U) != 0)
            tile.rows[level][y] = static_cast<std::uint8_t>(tile.rows[level][y] | 1U << x);
      }
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

std::uint32_t PlanarHierarchy::cellsBefore(const Tile& tile, unsigned bit) const
{
  const unsigned eighth = bit >> 3U;
  return tile.first_cell + tile.rank[eighth] + kBitCounts.of[tile.occupied >> (8 * eighth) & ((1U << (bit & 7U)) - 1U)];
}

CellContents::Block PlanarHierarchy::blockOf(const Tile& tile, int level, int x, int y) const
{
  const unsigned first = alongCurve(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) << (2 * level);
  const std::uint32_t begin = cellsBefore(tile, first);
  if (level == 0) return {begin, begin + 1};
  if (level == 1) return {begin, begin + kBitCounts.of[tile.occupied >> first & 15U]};
  const auto cells = static_cast<unsigned>(tile.occupied >> first & 0xFFFFU);
  return {begin, begin + kBitCounts.of[cells & 255U] + kBitCounts.of[cells >> 8U]};
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

/// Joins each block of the tile with those after it in the tile, those of the tile right of it and those of the tiles
/// above: half of all, the other half looks here.
void PlanarHierarchy::linkTile(const Tile& tile, int level, int reach, float distance)
{
  static const Tile kEmpty = {};
  const auto at = [this](std::uint32_t i) -> const Tile& { return i == kNone ? kEmpty : tiles_[i]; };
  const Tile* const tiles[2][3] = {{&kEmpty, &tile, &at(tile.beside[0])},
                                   {&at(tile.beside[1]), &at(tile.beside[2]), &at(tile.beside[3])}};
  const int side = kSide >> level;
  std::uint32_t rows[kSide + 3];
  for (int y = 0; y < side + reach; ++y)
  {
    rows[y] = 0;
    for (int k = 0; k < 3; ++k)
      rows[y] |= static_cast<std::uint32_t>(tiles[y / side][k]->rows[level][y % side]) << (k * side);
  }
  const std::uint32_t window = (2U << (2 * reach)) - 1U;
  for (int y = 0; y < side; ++y)
    for (unsigned mine = tile.rows[level][y]; mine != 0; mine &= mine - 1U)
    {
      const int x = __builtin_ctz(mine);
      const CellContents::Block block = blockOf(tile, level, x, y);
      for (int row = std::max(0, y - reach); row <= y + reach; ++row)
      {
        // below: only the tile on the right; beside: only what is right of it
        const std::uint32_t from = row < y ? 2 * side : row == y ? side + x + 1 : 0;
        std::uint32_t others = rows[row] & window << (side + x - reach) & ~0U << from;
        for (; others != 0; others &= others - 1U)
        {
          const int column = __builtin_ctz(others);
          const CellContents::Block other =
              blockOf(*tiles[row / side][column / side], level, column % side, row % side);
          if (component_[block.begin] != component_[other.begin] &&
              sets_.find(block.begin) != sets_.find(other.begin) && cells_.areCloser(block, other, distance))
            sets_.unite(block.begin, other.begin);
        }
      }
    }
}
}  // namespace lidar_panoptic_clustering
