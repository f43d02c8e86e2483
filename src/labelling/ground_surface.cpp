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
constexpr std::uint32_t kNoCell = kCells;  // where what is no return goes, so that nothing has to be asked a point

const PolarGrid kGrid;

/// Coordinates of four points.
struct FourPoints
{
  explicit FourPoints(const LabelledPoint* p)
      : x{p[0].x, p[1].x, p[2].x, p[3].x}, y{p[0].y, p[1].y, p[2].y, p[3].y}, z{p[0].z, p[1].z, p[2].z, p[3].z}
  {
  }

  FourFloats x, y, z;
};

/// Ranges and cells of four points.
inline void locate(const LabelledPoint* points, float max_squared_range, GroundedReturn* returns, std::uint16_t* cells)
{
  const FourPoints p(points);
  const FourFloats squared = p.x * p.x + p.y * p.y, whole = squared + p.z * p.z;
  const FourInts is_return = (squared > 0.0F) & (whole <= max_squared_range);  // not NaN and infinity
  const FourFloats range = select(is_return, squareRoot(squared), broadcast(kNaN));
  kGrid.cellsOf(p.x, p.y, range, is_return, cells);
  for (int k = 0; k < 4; ++k) returns[k] = {range[k], kNaN};
}
}  // namespace

GroundSurface::GroundSurface() : lowest_(kCells + 1), ground_(kCells), expected_(kSectors), lines_(kCells + 1)
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
  lowest_.assign(kCells + 1, {kFar, 0, -kFar});
  cell_of_.resize(size);
  returns.resize(size);
  std::size_t i = 0;
  for (; i + 4 <= size; i += 4) locate(&cloud.points[i], max_squared_range, &returns[i], &cell_of_[i]);
  if (i < size)
  {
    LabelledPoint rest[4];
    std::copy(cloud.points.begin() + static_cast<std::ptrdiff_t>(i), cloud.points.end(), rest);
    GroundedReturn rest_returns[4];
    std::uint16_t rest_cells[4];
    locate(rest, max_squared_range, rest_returns, rest_cells);
    std::copy_n(rest_returns, size - i, &returns[i]);
    std::copy_n(rest_cells, size - i, &cell_of_[i]);
  }
  Lowest* const lowest = lowest_.data();
  for (i = 0; i < size; ++i)
  {
    Lowest& low = lowest[cell_of_[i]];
    const float z = cloud.points[i].z;
    // without a branch: no predictor knows which return is lower
    const std::uint32_t is_lower = 0U - static_cast<std::uint32_t>(z < low.z);
    low.z = std::min(low.z, z);
    low.top = std::max(low.top, z);
    low.point = (static_cast<std::uint32_t>(i) & is_lower) | (low.point & ~is_lower);
  }
  lowest_[kNoCell] = {kFar, 0, -kFar};
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
  lines_[kNoCell] = {0.0F, 0.0F, 0.0F};
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
  const auto write = [&](std::size_t i, float height)  // NaN where the range is
  { returns[i].height = height - groundAt(cell_of_[i], returns[i].range); };
  std::size_t i = begin;
  for (; i + 4 <= end; i += 4)
  {
    const FourPoints p(&cloud.points[i]);
    const FourFloats height = p.z - plane.slope_x * p.x - plane.slope_y * p.y - plane.offset;
    for (int k = 0; k < 4; ++k) write(i + static_cast<std::size_t>(k), height[k]);
  }
  for (; i < end; ++i) write(i, plane.heightOf(cloud.points[i].x, cloud.points[i].y, cloud.points[i].z));
}
}  // namespace lidar_panoptic_clustering
