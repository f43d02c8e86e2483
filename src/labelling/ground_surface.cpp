#include "lidar_panoptic_clustering/labelling/ground_surface.h"

#include "polar_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint16_t kNoCell = 0xFFFF;
constexpr std::uint32_t kBins = PolarGrid::kBins, kCells = PolarGrid::kCells;

const PolarGrid kGrid;

/// Coordinates of four points, of fewer where a cloud ends: then the last one's again.
struct FourPoints
{
  FourPoints(const LabelledPoint* points, std::size_t count)
  {
    const std::size_t last = std::min<std::size_t>(count, 4) - 1;
    const LabelledPoint &a = points[0], &b = points[std::min<std::size_t>(last, 1)],
                        &c = points[std::min<std::size_t>(last, 2)], &d = points[last];
    x = FourFloats{a.x, b.x, c.x, d.x}, y = FourFloats{a.y, b.y, c.y, d.y}, z = FourFloats{a.z, b.z, c.z, d.z};
  }

  FourFloats x, y, z;
};
}  // namespace

GroundSurface::GroundSurface() : lowest_(kCells), ground_(kCells), expected_(kSectors), lines_(kCells)
{
  static_assert(kSectors == PolarGrid::kSectors);
}

bool GroundSurface::find(const LabelledCloud& cloud, float max_range_m, float max_slope,
                         std::vector<GroundedReturn>& returns)
{
  sortIntoCells(cloud, max_range_m, returns);
  const bool found = findPlane(cloud);
  if (found)
  {
    follow(cloud, returns, max_slope);
    bridge();
  }
  else
    flatten();
  drawLines();
  return found;
}

void GroundSurface::sortIntoCells(const LabelledCloud& cloud, float max_range_m, std::vector<GroundedReturn>& returns)
{
  const float max_squared_range = max_range_m * max_range_m;
  const std::size_t size = cloud.points.size();
  lowest_.assign(kCells, {kFar, 0, -kFar});
  cell_of_.resize(size);
  returns.resize(size);
  std::uint32_t open = 0;  // neighbours share a cell: it is kept at hand until the next one
  Lowest low = lowest_[open];
  for (std::size_t first = 0; first < size; first += 4)
  {
    const FourPoints p(cloud.points.data() + first, size - first);
    const FourFloats squared = p.x * p.x + p.y * p.y, whole = squared + p.z * p.z;
    const FourInts is_return = (squared > 0.0F) & (whole <= max_squared_range);  // not NaN and infinity
    const FourFloats range = select(is_return, squareRoot(squared), broadcast(kNaN));
    std::uint32_t cells[4];
    kGrid.cellsOf(p.x, p.y, range, cells);
    for (int k = 0; k < 4; ++k)
    {
      const std::size_t i = first + static_cast<std::size_t>(k);
      if (i >= size) break;
      returns[i] = {range[k], kNaN};
      const std::uint32_t cell = is_return[k] != 0 ? cells[k] : kNoCell;
      cell_of_[i] = static_cast<std::uint16_t>(cell);
      if (cell == kNoCell) continue;
      if (cell != open)
      {
        lowest_[open] = low;
        open = cell;
        low = lowest_[open];
      }
      const float z = p.z[k];
      const bool lower = z < low.z;  // without a branch: no predictor knows which return is lower
      low.z = lower ? z : low.z;
      low.top = std::max(low.top, z);
      low.point = lower ? static_cast<std::uint32_t>(i) : low.point;
    }
  }
  lowest_[open] = low;
}

bool GroundSurface::findPlane(const LabelledCloud& cloud)
{
  constexpr float kReach = 20.0F;  // [m]
  near_.clear();
  float bottom = kFar;
  for (const Lowest& low : lowest_) bottom = std::min(bottom, low.z);
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
    for (std::uint32_t bin = 0; kGrid.middleOf(bin) < kReach; ++bin)
    {
      const Lowest& low = lowest_[PolarGrid::cell(bin, sector)];
      if (low.z == kFar) continue;
      const LabelledPoint& p = cloud.points[low.point];
      near_.push_back({p.x, p.y, p.z});
    }
  if (findGroundPlane(near_, plane_)) return true;
  plane_ = {0.0F, 0.0F, bottom};
  return false;
}

void GroundSurface::follow(const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns, float max_slope)
{
  std::fill_n(ground_.begin(), kSectors, Ground{0.0F, 0.0F, 0.0F, 1.0F});
  for (std::uint32_t bin = 1; bin < kBins; ++bin)
  {
    followTo(bin, cloud, returns, max_slope);
    refuseIslands(bin);
  }
}

/// The cells of a bin, from those inside of them.
void GroundSurface::followTo(std::uint32_t bin, const LabelledCloud& cloud, const std::vector<GroundedReturn>& returns,
                             float max_slope)
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
    if (lowest.z == kFar) continue;
    const LabelledPoint& low = cloud.points[lowest.point];
    const float found = plane_.heightOf(low.x, low.y, low.z);
    const bool is_face = lowest.top - lowest.z > kFace;
    const float gate = std::min(is_face ? kFaceStep : kMostStep, kNoise + max_slope * (unseen + step));
    if (std::abs(found - expected) < gate) ground_[cell] = {found, returns[lowest.point].range, 0.0F, 1.0F};
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
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
  {
    const Ground& here = ground_[cell];
    const bool is_last = cell + kSectors >= kCells;
    const Ground& next = is_last ? here : ground_[cell + kSectors];
    lines_[cell] = {here.distance, here.height,
                    is_last ? 0.0F : (next.height - here.height) / (next.distance - here.distance)};
  }
}

float GroundSurface::heightOf(float x, float y, float z) const
{
  const float range = std::sqrt(x * x + y * y);
  return plane_.heightOf(x, y, z) - groundAt(kGrid.cellOf(x, y, range), range);
}

void GroundSurface::writeHeights(const LabelledCloud& cloud, std::size_t begin, std::size_t end,
                                 std::vector<GroundedReturn>& returns) const
{
  const SlopedPlane plane = plane_;
  for (std::size_t first = begin; first < end; first += 4)
  {
    const FourPoints p(cloud.points.data() + first, end - first);
    const FourFloats height = p.z - plane.slope_x * p.x - plane.slope_y * p.y - plane.offset;
    for (int k = 0; k < 4; ++k)
    {
      const std::size_t i = first + static_cast<std::size_t>(k);
      if (i >= end) break;
      if (cell_of_[i] != kNoCell) returns[i].height = height[k] - groundAt(cell_of_[i], returns[i].range);
    }
  }
}
}  // namespace lidar_panoptic_clustering
