#include "lidar_panoptic_clustering/labelling/ground_surface.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint16_t kNoCell = 0xFFFF;

constexpr std::uint32_t kSectors = 180;  // two degrees: half a metre at 15 m

// bins of range grow with it, as the rings on the ground move apart
struct Zone
{
  float end, width;  // [m]
};
constexpr std::array<Zone, 4> kZones = {{{10.0F, 0.5F}, {30.0F, 1.0F}, {60.0F, 2.0F}, {120.0F, 4.0F}}};
constexpr float kFinest = 0.5F;
constexpr std::uint32_t kBins = 20 + 20 + 15 + 15;
constexpr std::uint32_t kCells = kSectors * kBins;

/// The bins' places, and the bin of each half metre.
struct Bins
{
  std::array<float, kBins> middle{}, width{};
  std::array<std::uint8_t, 240> of_step{};

  Bins()
  {
    std::uint32_t bin = 0;
    float begin = 0.0F;
    for (const Zone& zone : kZones)
      for (; begin < zone.end; begin += zone.width, ++bin)
      {
        middle[bin] = begin + 0.5F * zone.width, width[bin] = zone.width;
        const auto first = static_cast<std::size_t>(begin / kFinest);
        const auto last = static_cast<std::size_t>((begin + zone.width) / kFinest);
        for (std::size_t step = first; step < last; ++step) of_step[step] = static_cast<std::uint8_t>(bin);
      }
  }

  /// The last bin holds all beyond it.
  std::uint32_t find(float range) const
  {
    const auto step = static_cast<std::uint32_t>(range / kFinest);
    return of_step[std::min<std::size_t>(step, of_step.size() - 1)];
  }
};

const Bins kGrid;

/// By the angle of the square that turns with x and y instead of the circle's: no trigonometry.
std::uint32_t sectorOf(float x, float y)
{
  const float turn = y / (std::abs(x) + std::abs(y));            // -1..1
  const float quarters = x >= 0.0F ? 1.0F + turn : 3.0F - turn;  // 0..4
  return std::min(kSectors - 1, static_cast<std::uint32_t>(quarters * (0.25F * kSectors)));
}
}  // namespace

GroundSurface::GroundSurface()
    : lowest_(kCells), ground_(kCells), distance_(kCells), unseen_(kCells), expected_(kSectors), lines_(kCells)
{
}

bool GroundSurface::measure(const LabelledCloud& cloud, float max_range_m, float max_slope,
                            std::vector<GroundedReturn>& returns)
{
  sortIntoCells(cloud, max_range_m, returns);
  const bool found = findPlane(cloud);
  if (found)
  {
    follow(cloud, max_slope);
    bridge();
  }
  else
    flatten();
  writeHeights(cloud, returns);
  return found;
}

void GroundSurface::sortIntoCells(const LabelledCloud& cloud, float max_range_m, std::vector<GroundedReturn>& returns)
{
  const float max_squared_range = max_range_m * max_range_m;
  lowest_.assign(kCells, {kFar, 0, -kFar});
  cell_of_.resize(cloud.points.size());
  returns.resize(cloud.points.size());
  std::uint32_t open = 0;  // neighbours share a cell: it is kept at hand until the next one
  Lowest low = lowest_[open];
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    const LabelledPoint& p = cloud.points[i];
    const float squared = p.x * p.x + p.y * p.y, whole = squared + p.z * p.z;
    if (!(squared > 0.0F && whole <= max_squared_range))  // NaN and infinity too
    {
      cell_of_[i] = kNoCell;
      returns[i] = {kNaN, kNaN};
      continue;
    }
    const float range = returns[i].range = std::sqrt(squared);
    const std::uint32_t cell = sectorOf(p.x, p.y) * kBins + kGrid.find(range);
    cell_of_[i] = static_cast<std::uint16_t>(cell);
    if (cell != open)
    {
      lowest_[open] = low;
      open = cell;
      low = lowest_[open];
    }
    const bool lower = p.z < low.z;  // without a branch: no predictor knows which return is lower
    low.z = lower ? p.z : low.z;
    low.top = std::max(low.top, p.z);
    low.point = lower ? static_cast<std::uint32_t>(i) : low.point;
  }
  lowest_[open] = low;
}

bool GroundSurface::findPlane(const LabelledCloud& cloud)
{
  constexpr float kReach = 20.0F;      // [m]
  constexpr std::size_t kFewest = 10;  // cells
  constexpr float kGates[] = {0.5F, 0.3F, 0.2F, 0.2F};
  plane_ = {};
  near_.clear();
  float bottom = kFar;
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
  {
    if (lowest_[cell].z == kFar) continue;
    bottom = std::min(bottom, lowest_[cell].z);
    if (kGrid.middle[cell % kBins] >= kReach) continue;
    const LabelledPoint& p = cloud.points[lowest_[cell].point];
    near_.push_back({p.x, p.y, p.z});
  }
  std::size_t on_plane = 0;
  if (near_.size() >= kFewest)
  {
    votePlane();
    for (const float gate : kGates) on_plane = fitPlane(gate);
  }
  const bool is_below = plane_.offset < 0.0F;  // the sensor; above it is the ground of one that stands on its head
  if (is_below && on_plane >= std::max(kFewest, near_.size() / 10)) return true;
  plane_ = {0.0F, 0.0F, bottom};
  return false;
}

/// The slopes and offset that most of the cells agree on, coarsely.
void GroundSurface::votePlane()
{
  constexpr int kSlopes = 6;  // either side, two degrees each
  constexpr float kSlopeStep = 0.035F, kOffsetStep = 0.25F;
  constexpr std::size_t kOffsets = 48;  // down to 12 m below the sensor
  constexpr std::size_t kVoters = 300;
  const std::size_t stride = 1 + near_.size() / kVoters;
  int most = -1;
  for (int v = -kSlopes; v <= kSlopes; ++v)
    for (int u = -kSlopes; u <= kSlopes; ++u)
    {
      const SlopedPlane plane{kSlopeStep * static_cast<float>(u), kSlopeStep * static_cast<float>(v), 0.0F};
      std::array<int, kOffsets + 1> votes{};
      for (std::size_t i = 0; i < near_.size(); i += stride)
      {
        const float below = -plane.heightOf(near_[i].x, near_[i].y, near_[i].z) / kOffsetStep;
        if (below > 0.0F && below < kOffsets) ++votes[static_cast<std::size_t>(below)];
      }
      for (std::size_t k = 0; k < kOffsets; ++k)
        if (votes[k] + votes[k + 1] > most)
        {
          most = votes[k] + votes[k + 1];
          plane_ = {plane.slope_x, plane.slope_y, -kOffsetStep * static_cast<float>(k + 1)};
        }
    }
}

/// Least squares through the cells within `gate` of the plane so far; returns how many there are.
std::size_t GroundSurface::fitPlane(float gate)
{
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const Low& low : near_)
  {
    if (std::abs(plane_.heightOf(low.x, low.y, low.z)) > gate) continue;
    const Eigen::Vector3d row(low.x, low.y, 1.0);
    normal += row * row.transpose();
    right += row * static_cast<double>(low.z);
    ++count;
  }
  // a ridge of a millimetre a metre: what the cells do not tell, such as the slope across a single row, stays level
  normal.diagonal() += Eigen::Vector3d(1e-3, 1e-3, 1e-9);
  const Eigen::Vector3f solution = normal.ldlt().solve(right).cast<float>();
  plane_ = {solution.x(), solution.y(), solution.z()};
  return count;
}

void GroundSurface::follow(const LabelledCloud& cloud, float max_slope)
{
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
  {
    const std::uint32_t cell = sector * kBins;
    ground_[cell] = distance_[cell] = unseen_[cell] = 0.0F;
  }
  for (std::uint32_t bin = 1; bin < kBins; ++bin)
  {
    followTo(bin, cloud, max_slope);
    refuseIslands(bin);
  }
}

/// The cells of a bin, from those inside of them.
void GroundSurface::followTo(std::uint32_t bin, const LabelledCloud& cloud, float max_slope)
{
  constexpr float kNoise = 0.12F;    // [m] range noise, gravel, grass
  constexpr float kMostStep = 0.5F;  // [m] below a bumper
  // [m] what rises by more within a cell is a face of something, whose lower edge may hang over the ground by a sill
  constexpr float kFace = 0.3F, kFaceStep = 0.15F;
  const float step = kGrid.middle[bin] - kGrid.middle[bin - 1];
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
  {
    const std::uint32_t inside[] = {sector * kBins + bin - 1, (sector + 1) % kSectors * kBins + bin - 1,
                                    (sector + kSectors - 1) % kSectors * kBins + bin - 1};
    float weights = 0.0F, expected = 0.0F, unseen = kFar;
    for (const std::uint32_t neighbour : inside)
    {
      const float weight = 1.0F / (1.0F + unseen_[neighbour]);
      weights += weight, expected += weight * ground_[neighbour];
      unseen = std::min(unseen, unseen_[neighbour]);
    }
    expected /= weights;

    const std::uint32_t cell = sector * kBins + bin;
    const LabelledPoint& low = cloud.points[lowest_[cell].point];
    const float found = plane_.heightOf(low.x, low.y, low.z);
    const bool is_face = lowest_[cell].top - lowest_[cell].z > kFace;
    const float gate = std::min(is_face ? kFaceStep : kMostStep, kNoise + max_slope * (unseen + step));
    const bool seen = lowest_[cell].z != kFar && std::abs(found - expected) < gate;
    expected_[sector] = expected;
    ground_[cell] = seen ? found : expected;
    distance_[cell] = seen ? std::hypot(low.x, low.y) : kGrid.middle[bin];
    unseen_[cell] = seen ? 0.0F : unseen + step;
  }
}

/// What rises out of ground that was not seen for a while, no wider than a car is long, and with no such rise on
/// either side of it, is the sill of one: slopes are wider.
void GroundSurface::refuseIslands(std::uint32_t bin)
{
  constexpr float kRise = 0.2F;    // [m] a sill hangs as high at least
  constexpr float kWidest = 6.0F;  // [m] a car and a cell
  const float width = kGrid.middle[bin] * 2.0F * 3.14159265F / kSectors;
  const auto cellOf = [&](std::uint32_t sector) { return sector % kSectors * kBins + bin; };
  const auto rises = [&](std::uint32_t sector)
  { return unseen_[cellOf(sector)] == 0.0F && ground_[cellOf(sector)] - expected_[sector % kSectors] > kRise; };
  const auto widest = std::min(kSectors - 1, static_cast<std::uint32_t>(kWidest / width));
  for (std::uint32_t begin = 0; begin < kSectors; ++begin)
  {
    if (!rises(begin) || rises(begin + kSectors - 1)) continue;
    std::uint32_t end = begin;
    while (end - begin <= widest && rises(end)) ++end;
    if (end - begin > widest) continue;
    for (std::uint32_t sector = begin; sector < end; ++sector)
    {
      const std::uint32_t cell = cellOf(sector), inner = cell - 1;
      ground_[cell] = expected_[sector % kSectors];
      distance_[cell] = kGrid.middle[bin];
      unseen_[cell] = unseen_[inner] + kGrid.middle[bin] - kGrid.middle[bin - 1];
    }
  }
}

void GroundSurface::bridge()
{
  for (std::uint32_t sector = 0; sector < kSectors; ++sector)
  {
    const std::uint32_t begin = sector * kBins;
    std::uint32_t inner = begin;
    for (std::uint32_t outer = begin + 1; outer < begin + kBins; ++outer)
    {
      if (unseen_[outer] > 0.0F) continue;
      const float rise = (ground_[outer] - ground_[inner]) / (distance_[outer] - distance_[inner]);
      for (std::uint32_t cell = inner + 1; cell < outer; ++cell)
        ground_[cell] = ground_[inner] + rise * (distance_[cell] - distance_[inner]);
      inner = outer;
    }
  }
}

/// No ground but the plane.
void GroundSurface::flatten()
{
  std::fill(ground_.begin(), ground_.end(), 0.0F);
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
    distance_[cell] = cell % kBins == 0 ? 0.0F : kGrid.middle[cell % kBins];
}

float GroundSurface::heightOf(float x, float y, float z) const
{
  const float range = std::sqrt(x * x + y * y);
  return plane_.heightOf(x, y, z) - groundAt(sectorOf(x, y) * kBins + kGrid.find(range), range);
}

void GroundSurface::writeHeights(const LabelledCloud& cloud, std::vector<GroundedReturn>& returns)
{
  for (std::uint32_t cell = 0; cell < kCells; ++cell)
  {
    const bool is_last = (cell + 1) % kBins == 0;
    lines_[cell] = {distance_[cell], ground_[cell],
                    is_last ? 0.0F : (ground_[cell + 1] - ground_[cell]) / (distance_[cell + 1] - distance_[cell])};
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    if (cell_of_[i] == kNoCell) continue;
    const LabelledPoint& p = cloud.points[i];
    returns[i].height = plane_.heightOf(p.x, p.y, p.z) - groundAt(cell_of_[i], returns[i].range);
  }
}
}  // namespace lidar_panoptic_clustering
