#include "lidar_panoptic_clustering/labelling/ground_surface.h"

#include "polar_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kBins = PolarGrid::kBins, kCells = PolarGrid::kCells;
constexpr std::uint16_t kNoCell = kCells;  // where what is no return goes, so that nothing has to be asked a point

constexpr std::size_t kBlock = 256;  // points, a multiple of four, that stay in the nearest cache

const PolarGrid kGrid;
constexpr std::int64_t kNothing = std::numeric_limits<std::int64_t>::max();

/// Ranges of four points, NaN for those that are no returns.
inline FourFloats rangesOf(const FourPoints& p, const FourInts& is_return)
{
  return select(is_return, squareRoot(p.x * p.x + p.y * p.y), broadcast(kNaN));
}

inline FourInts areReturns(const FourPoints& p, float max_squared_range)
{
  const FourFloats squared = p.x * p.x + p.y * p.y;
  return (squared > 0.0F) & (squared + p.z * p.z <= max_squared_range);  // not NaN and infinity
}

/// Cells of points, a multiple of four.
void findCells(const LabelledPoint* points, std::size_t size, float max_range_m, std::uint16_t* cells)
{
  const float max_squared_range = max_range_m * max_range_m;
  for (std::size_t i = 0; i < size; i += 4)
  {
    const FourPoints p(points + i);
    const FourInts is_return = areReturns(p, max_squared_range);
    writeShorts(PolarGrid::cellsOf(p.x, p.y, squareRoot(p.x * p.x + p.y * p.y), is_return), cells + i);
  }
}

/// A number in whose order heights lie, and of the same height the places.
inline std::int64_t placeByHeight(float height, std::size_t place)
{
  std::int32_t bits;
  std::memcpy(&bits, &height, sizeof(bits));
  const std::int32_t ordered = bits ^ ((bits >> 31) & 0x7FFFFFFF);
  return std::int64_t{ordered} * (std::int64_t{1} << 32) + static_cast<std::int64_t>(place);
}

/// The last points of a cloud whose size is no multiple of four, as four.
struct LastPoints
{
  LastPoints(const LabelledCloud& cloud, std::size_t begin, std::size_t end)
  {
    std::copy(&cloud.points[begin], &cloud.points[begin] + (end - begin), points);
  }
  LabelledPoint points[4];
};
}  // namespace

GroundSurface::GroundSurface()
    : returns_(kCells + 1),
      lowest_returns_(kCells),
      lowest_(kCells),
      ground_(kCells),
      expected_(kSectors),
      lines_(kCells + 1)
{
  static_assert(kSectors == PolarGrid::kSectors);
}

bool GroundSurface::find(const LabelledCloud& cloud, float max_range_m, float max_slope)
{
  sortIntoCells(cloud, max_range_m);
  const bool found = findPlane(cloud);
  if (found)
  {
    measureLowest();
    follow(max_slope);
    bridge();
  }
  else
    flatten();
  drawLines();
  return found;
}

void GroundSurface::sortIntoCells(const LabelledCloud& cloud, float max_range_m)
{
  returns_.assign(kCells + 1, {kNothing, -kFar});
  const std::size_t size = cloud.points.size(), whole = size / 4 * 4;
  cell_of_.resize(size);
  for (std::size_t begin = 0; begin < whole; begin += kBlock)
  {
    const std::size_t end = std::min(begin + kBlock, whole);
    findCells(&cloud.points[begin], end - begin, max_range_m, &cell_of_[begin]);
    takeLowest(cloud, begin, end);
  }
  if (whole == size) return;
  const LastPoints last(cloud, whole, size);
  std::uint16_t cells[4];
  findCells(last.points, 4, max_range_m, cells);
  std::copy_n(cells, size - whole, &cell_of_[whole]);
  takeLowest(cloud, whole, size);
}

void GroundSurface::takeLowest(const LabelledCloud& cloud, std::size_t begin, std::size_t end)
{
  CellReturns* const cells = returns_.data();
  const std::uint16_t* const cell_of = cell_of_.data();
  const LabelledPoint* const points = cloud.points.data();
  for (std::size_t i = begin; i < end; ++i)
  {
    CellReturns& here = cells[cell_of[i]];
    const float z = points[i].z;
    // without a branch: no predictor knows which return is lower
    here.lowest = std::min(here.lowest, placeByHeight(z, i));
    here.top = std::max(here.top, z);
  }
}

bool GroundSurface::findPlane(const LabelledCloud& cloud)
{
  constexpr float kReach = 20.0F;  // [m]
  near_.clear();
  float bottom = kFar;
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
  {
    lowest_returns_[cell] = {kNaN, kNaN, kNaN};
    if (returns_[cell].lowest == kNothing) continue;
    const LabelledPoint& p = cloud.points[static_cast<std::uint32_t>(returns_[cell].lowest)];
    lowest_returns_[cell] = {p.x, p.y, p.z};
    bottom = std::min(bottom, p.z);
  }
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
    for (std::uint32_t bin = 0; kGrid.middleOf(bin) < kReach; ++bin)
      if (const LowReturn& low = lowest_returns_[PolarGrid::cell(bin, sector)]; !std::isnan(low.z))
        near_.push_back(low);
  if (findGroundPlane(near_, plane_)) return true;
  plane_ = {0.0F, 0.0F, bottom};
  return false;
}

void GroundSurface::measureLowest()
{
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
  {
    const LowReturn& low = lowest_returns_[cell];
    const float range = std::sqrt(low.x * low.x + low.y * low.y);
    lowest_[cell] = {plane_.heightOf(low.x, low.y, low.z), range > 0.0F ? range : 0.0F, returns_[cell].top - low.z};
  }
}

void GroundSurface::follow(float max_slope)
{
  std::fill_n(ground_.begin(), kSectors, Ground{0.0F, 0.0F, 0.0F, 1.0F});
  for (std::uint32_t bin = 1; bin < kBins; ++bin)
  {
    followTo(bin, max_slope);
    refuseIslands(bin);
  }
}

/// The cells of a bin, from those inside of them.
void GroundSurface::followTo(std::uint32_t bin, float max_slope)
{
  constexpr float kNoise = 0.12F;    // [m] range noise, gravel, grass
  constexpr float kMostStep = 0.5F;  // [m] below a bumper
  // [m] what rises by more within a cell is a face of something, whose lower edge may hang over the ground by a sill
  constexpr float kFace = 0.3F, kFaceStep = 0.15F;
  const float middle = kGrid.middleOf(bin), step = middle - kGrid.middleOf(bin - 1);
  const Ground* const inner = &ground_[PolarGrid::cell(bin - 1, 0)];
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
  {
    const Ground &inside = inner[sector], &left = inner[sector + 1 < kSectors ? sector + 1 : 0],
                 &right = inner[sector > 0 ? sector - 1 : kSectors - 1];
    const float weights = inside.weight + left.weight + right.weight;
    const float expected =
        (inside.weight * inside.height + left.weight * left.height + right.weight * right.height) / weights;
    const float unseen = std::min(inside.unseen, std::min(left.unseen, right.unseen));

    const std::uint32_t cell = PolarGrid::cell(bin, sector);
    const Lowest& lowest = lowest_[cell];
    expected_[sector] = expected;
    ground_[cell] = {expected, middle, unseen + step, 1.0F / (1.0F + unseen + step)};
    const bool is_face = lowest.rise > kFace;
    const float gate = std::min(is_face ? kFaceStep : kMostStep, kNoise + max_slope * (unseen + step));
    if (lowest.range > 0.0F && std::abs(lowest.height - expected) < gate)
      ground_[cell] = {lowest.height, lowest.range, 0.0F, 1.0F};
  }
}

/// What rises out of ground that was not seen for a while, no wider than a car is long, and with no such rise on
/// either side of it, is the sill of one: slopes are wider.
void GroundSurface::refuseIslands(std::uint32_t bin)
{
  constexpr float kRise = 0.2F;    // [m] a sill hangs as high at least
  constexpr float kWidest = 6.0F;  // [m] a car and a cell
  const float middle = kGrid.middleOf(bin), step = middle - kGrid.middleOf(bin - 1);
  const float width = middle * 2.0F * 3.14159265F / kSectors;
  Ground* const here = &ground_[PolarGrid::cell(bin, 0)];
  const auto rises = [&](std::uint32_t sector)
  {
    const std::uint32_t s = sector < kSectors ? sector : sector - kSectors;
    return here[s].unseen == 0.0F && here[s].height - expected_[s] > kRise;
  };
  const auto widest = std::min(kSectors - 1, static_cast<std::uint32_t>(kWidest / width));
  for (std::uint32_t begin = 0; begin < kSectors; ++begin)
  {
    if (!rises(begin) || rises(begin + kSectors - 1)) continue;
    std::uint32_t end = begin;
    while (end - begin <= widest && rises(end)) ++end;
    if (end - begin > widest) continue;
    for (std::uint32_t k = begin; k < end; ++k)
    {
      const std::uint32_t sector = k % kSectors;
      const float unseen = ground_[PolarGrid::cell(bin - 1, sector)].unseen + step;
      here[sector] = {expected_[sector], middle, unseen, 1.0F / (1.0F + unseen)};
    }
  }
}

void GroundSurface::bridge()
{
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
  {
    std::uint32_t inner = 0;
    for (std::uint32_t outer = 1; outer < kBins; ++outer)
    {
      const Ground& far = ground_[PolarGrid::cell(outer, sector)];
      if (far.unseen > 0.0F) continue;
      const Ground& near = ground_[PolarGrid::cell(inner, sector)];
      for (std::uint32_t bin = inner + 1; bin < outer; ++bin)
      {
        Ground& between = ground_[PolarGrid::cell(bin, sector)];
        const float rise = (far.height - near.height) / (far.distance - near.distance);
        between.height = near.height + rise * (between.distance - near.distance);
      }
      inner = outer;
    }
  }
}

/// No ground but the plane.
void GroundSurface::flatten()
{
  for (std::uint32_t bin = 0; bin < kBins; ++bin)
    std::fill_n(&ground_[PolarGrid::cell(bin, 0)], kSectors,
                Ground{0.0F, bin == 0 ? 0.0F : kGrid.middleOf(bin), 0.0F, 1.0F});
}

void GroundSurface::drawLines()
{
  lines_[kNoCell] = {};
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
  {
    const Ground& here = ground_[cell];
    const bool is_last = cell + kSectors >= kCells;
    const Ground& next = is_last ? here : ground_[cell + kSectors];
    lines_[cell] = {here.distance, here.height,
                    is_last ? 0.0F : (next.height - here.height) / (next.distance - here.distance), 0.0F};
  }
}

float GroundSurface::heightOf(float x, float y, float z) const
{
  const float range = std::sqrt(x * x + y * y);
  return plane_.heightOf(x, y, z) - groundAt(kGrid.cellOf(x, y, range), range);
}

void GroundSurface::locate(const LabelledCloud& cloud, std::size_t begin, std::size_t end,
                           std::vector<GroundedReturn>& returns) const
{
  const SlopedPlane plane = plane_;
  const Line* const lines = lines_.data();
  const auto locateFour = [&](const LabelledPoint* points, const std::uint16_t* cells, GroundedReturn* to)
  {
    const FourPoints p(points);
    FourInts cell = {cells[0], cells[1], cells[2], cells[3]};
    const FourFloats range = rangesOf(p, cell != static_cast<std::int32_t>(kNoCell));
    const FourFloats begins = {lines[cells[0]].distance, lines[cells[1]].distance, lines[cells[2]].distance,
                               lines[cells[3]].distance};
    cell -= (range < begins) & static_cast<std::int32_t>(kSectors);  // the first bin has its at 0 m
    const auto line = [&](int k) { return loadFour(&lines[static_cast<std::uint32_t>(cell[k])].distance); };
    const FourColumns from(line(0), line(1), line(2), line(3));  // distance, ground, rise
    const FourFloats over_plane = p.z - plane.slope_x * p.x - plane.slope_y * p.y - plane.offset;
    writeInterleaved(range, over_plane - (from.second + from.third * (range - from.first)), &to->range);
  };
  std::size_t i = begin;
  for (; i + 4 <= end; i += 4) locateFour(&cloud.points[i], &cell_of_[i], &returns[i]);
  if (i == end) return;
  GroundedReturn rest[4];
  std::uint16_t cells[4] = {kNoCell, kNoCell, kNoCell, kNoCell};
  std::copy(&cell_of_[i], &cell_of_[i] + (end - i), cells);
  locateFour(LastPoints(cloud, i, end).points, cells, rest);
  std::copy(rest, rest + (end - i), &returns[i]);
}
}  // namespace lidar_panoptic_clustering
