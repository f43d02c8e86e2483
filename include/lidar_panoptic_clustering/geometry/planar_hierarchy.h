#pragma once

#include "lidar_panoptic_clustering/geometry/cell_contents.h"
#include "lidar_panoptic_clustering/geometry/disjoint_sets.h"
#include "lidar_panoptic_clustering/geometry/step_sort.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Which points hang together in bird's-eye view, at one distance after the other, on one hierarchy of square cells.
///
/// The diagonal of the smallest cells is the least distance: their points are closer than it without a comparison.
/// Four of them make a block of twice the side, four of these one of four times the side, and so on up to a tile of
/// 8 x 8 cells. Points lie in the order of tiles and, within a tile, along a Z-curve, so that every block is a range of
/// cells and of points, and is found by a bit. A distance is linked on the largest blocks whose diagonal it is no less
/// than: only blocks up to three either side can hold closer points. What hung together at a smaller distance is not
/// compared again. Keeps its memory.
///
/// Holds for coordinates of up to 10 km and distances of 0.2 mm and more: less than 2^27 cells.
class PlanarHierarchy
{
public:
  /// Begins anew. `distance` is the least one that link() will be called with [m].
  void clear(float distance);
  /// To be called for each point, then close().
  void add(float x, float y, std::uint32_t thing) { added_.push_back({x, y, thing}); }
  /// To be called after the last point: sorts them into cells. Linear (n log n where the cells' places need more than
  /// 32 bits).
  void close();

  /// Finds the components of "closer than `distance`" [m]. To be called with rising distances from that of clear() to
  /// five times as much. Linear in the cells, but for cells whose comparison takes longer (CellContents::areCloser).
  void link(float distance);

  /// Number of cells.
  std::uint32_t size() const { return cells_.size(); }
  /// The cell of the point that was the k-th to be added.
  std::uint32_t cellOf(std::size_t k) const { return cell_of_added_[k]; }
  /// By cell: one of the cells of its component, the same for all of them; as link() left it.
  const std::vector<std::uint32_t>& components() const { return component_; }
  /// The things of a cell, in the order they were added.
  template <class Visit>
  void forEach(std::uint32_t cell, const Visit& visit) const
  {
    for (const PlanarSample* p = cells_.begin(cell); p != cells_.end(cell); ++p) visit(p->thing);
  }
  /// The first of the things of a cell.
  std::uint32_t firstThing(std::uint32_t cell) const { return cells_.begin(cell)->thing; }

  /// Points looked at by comparisons since clear(), for tests that bound the work.
  std::size_t pointsLookedAt() const { return cells_.pointsLookedAt() + looked_at_; }

private:
  static constexpr int kLevels = 3;             // blocks of 1, 2 and 4 cells a side
  static constexpr int kSide = 8;               // cells a side of a tile
  static constexpr std::uint32_t kWindow = 32;  // columns of the window, of which three tiles' are in use
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  struct Tile
  {
    std::uint64_t place;                     ///< row-major; one unused column parts the rows
    std::uint64_t occupied = 0;              ///< a bit a cell, along the Z-curve
    std::uint32_t first_cell;                ///< its cells lie in order of their bits
    std::array<std::uint32_t, 4> beside;     ///< tiles right, and above: left, middle, right
    std::uint8_t rows[kLevels][kSide] = {};  ///< a bit an occupied block, row by row
  };
  /// Points added one after the other that lie in one cell.
  struct Run
  {
    std::uint64_t key;    ///< place of the tile, then along the curve
    std::uint32_t begin;  ///< of added_; the next one's is its end
  };
  /// A block near the tile in hand.
  struct Window
  {
    float x, y;  ///< its first point
    CellContents::Block block;
    std::uint32_t component;
    bool is_one;  ///< it holds no other point
  };

  void sortIntoCells();
  void placeRun(std::uint32_t run);
  void closeTiles();
  void findNeighbours();
  void uniteBlocks(int level);
  void findUniform();
  bool isSettled(const Tile& tile) const;
  void linkTiles(int level, int reach, float distance);
  void linkTile(const Tile& tile, int level, int reach, float distance);
  void linkBlocks(const Window& from, const Window& to, float distance);
  void moveWindow(const Tile& tile, int level);
  void lookAt(const Tile& tile, int level, int row, int column);
  Window& windowAt(int row, int column)
  {
    return window_[row][(static_cast<std::uint32_t>(column) + window_begin_) % kWindow];
  }

  float distance_ = 0.0F, cells_per_m_ = 0.0F;
  std::vector<PlanarSample> added_;
  std::vector<Run> runs_;
  std::vector<std::uint64_t> entries_;  ///< a run's key above, its number below
  StepSort<std::uint64_t> entry_sort_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> cell_of_added_;
  std::uint64_t stride_ = 1;  ///< tiles a row
  std::uint64_t last_key_ = 0;
  CellContents::Place tile_at_{};  ///< of the last tile
  std::uint32_t placed_ = 0;       ///< points that have their cell

  CellContents cells_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> uniform_;  ///< by tile: the component of all its cells, kNone where there are several
  Window window_[2 * kSide][kWindow];   ///< the tile in hand in the middle below, and those beside and above
  std::uint32_t rows_[2 * kSide] = {};  ///< of the window: a bit an occupied block
  std::uint32_t window_begin_ = 0;      ///< its first column in window_, which it moves around in
  const Tile* in_window_ = nullptr;     ///< the tile in the middle below
  int reach_of_row_[4] = {};            ///< blocks either side that may hold close points, by rows up or down
  std::size_t looked_at_ = 0;           ///< points of blocks that hold one
  DisjointSets sets_;
  std::vector<std::uint32_t> component_;
  int level_ = -1;  ///< of the blocks whose cells are joined; -1 before the first link()
};
}  // namespace lidar_panoptic_clustering
