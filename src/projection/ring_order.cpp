#include "lidar_panoptic_clustering/projection/ring_order.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kLeastSpacing = 5e-4;  // of rings: 0.03 degrees, a third of the finest sensor's
constexpr std::uint32_t kFewest = 200;  // returns that tell something
}  // namespace

void RingOrder::look(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions,
                     std::uint32_t rings, bool remember)
{
  sum(scan, directions, rings);
  if (remember) recall();
  tilt_ = 0.0;
  lookAlong(Eigen::Vector3d::UnitZ());
  if (!isMonotone() && !canBeSorted())
  {
    const Eigen::Vector3d axis = axisOfRings();
    lookAlong(axis);
    if (isMonotone() || canBeSorted())
      tilt_ = std::acos(std::min(1.0, axis.z()));
    else
      lookAlong(Eigen::Vector3d::UnitZ());
  }
  row_of_ring_.resize(rings);
  if (!isMonotone() && canBeSorted()) return sortByElevation();
  for (std::uint32_t ring = 0; ring < rings; ++ring) row_of_ring_[ring] = falls_ >= rises_ ? ring : rings - 1 - ring;
}

void RingOrder::sum(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions,
                    std::uint32_t rings)
{
  rings_.assign(rings, Ring());
  // a small scan is looked at whole
  const std::size_t step = scan.size() < 256 * std::size_t{rings} ? 1 : 13;
  for (std::size_t i = 0; i < scan.size(); i += step)
  {
    if (std::isnan(directions[i].azimuth)) continue;
    const ScanPoint& p = scan[i];
    const Eigen::Vector3d direction =
        Eigen::Vector3f(p.x, p.y, p.z).cast<double>() / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    Ring& ring = rings_[directions[i].row];
    ring.sum += direction;
    ring.sum_of_products.noalias() += direction * direction.transpose();
    ++ring.count;
  }
}

void RingOrder::recall()
{
  remembered_.resize(std::max(remembered_.size(), rings_.size()));
  for (std::size_t i = 0; i < rings_.size(); ++i)
  {
    if (rings_[i].count > 0)
      remembered_[i] = rings_[i];
    else
      rings_[i] = remembered_[i];
  }
}

void RingOrder::lookAlong(const Eigen::Vector3d& axis)
{
  scatter_ = 0.0;
  seen_ = 0;
  for (Ring& ring : rings_)
  {
    if (ring.count == 0) continue;
    ring.mean = axis.dot(ring.sum) / ring.count;
    ring.variance = std::max(0.0, axis.dot(ring.sum_of_products * axis) / ring.count - ring.mean * ring.mean);
    scatter_ += std::sqrt(ring.variance);
    ++seen_;
  }
  if (seen_ > 0) scatter_ /= seen_;
  countSteps();
}

void RingOrder::countSteps()
{
  falls_ = rises_ = 0;
  largest_fall_ = largest_rise_ = lowest_ = highest_ = 0.0;
  const Ring* last = nullptr;
  for (const Ring& ring : rings_)
  {
    if (ring.count == 0) continue;
    if (last == nullptr) lowest_ = highest_ = ring.mean;
    lowest_ = std::min(lowest_, ring.mean), highest_ = std::max(highest_, ring.mean);
    if (last != nullptr)
    {
      const double step = ring.mean - last->mean;
      falls_ += step<0.0, rises_ += step> 0.0;
      largest_fall_ = std::max(largest_fall_, -step), largest_rise_ = std::max(largest_rise_, step);
    }
    last = &ring;
  }
}

Eigen::Matrix3d RingOrder::scatterWithinRings() const
{
  Eigen::Matrix3d within = Eigen::Matrix3d::Zero();
  for (const Ring& ring : rings_)
    if (ring.count > 0) within += ring.sum_of_products - ring.sum * ring.sum.transpose() / ring.count;
  return within;
}

/// Directions along one ring have one elevation over the sensor's axis: that along which they vary least within rings.
Eigen::Vector3d RingOrder::axisOfRings() const
{
  const Eigen::Vector3d axis =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatterWithinRings()).eigenvectors().col(0);
  return axis.z() < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

std::optional<double> RingOrder::tiltOfAxis() const
{
  constexpr double kClearly =
      0.1;  // of the next larger variance; 1e-4 in KITTI's scans, 0.2 where rings are cut wrongly
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatterWithinRings());
  if (seen_ < 2 || !(solver.eigenvalues()[0] < kClearly * solver.eigenvalues()[1])) return std::nullopt;
  return std::acos(std::min(1.0, std::abs(solver.eigenvectors().col(0).z())));
}

bool RingOrder::isMonotone() const
{
  const int steps = falls_ + rises_;
  if (steps == 0) return false;
  const double back = falls_ > rises_ ? largest_rise_ : largest_fall_;
  return 10 * std::max(falls_, rises_) >= 9 * steps && back < 0.25 * (highest_ - lowest_);
}

void RingOrder::collectMeans() const
{
  means_.clear();
  for (const Ring& ring : rings_)
    if (ring.count > 0) means_.push_back(ring.mean);
}

/// Of rings in any sequence, a third and more go back against those a quarter of all before (as RoboSense fires), or
/// the way from ring to ring is many times the whole (as lasers fire in turn). In the vehicle's frame, where neighbours
/// go to and fro, sorted ones have 0 and at most 2.1 times.
bool RingOrder::goesNoWay() const
{
  constexpr int kFewestRings = 4;
  constexpr double kLeastMajority = 0.8, kLongestWay = 4.0;
  if (seen_ < kFewestRings || returns() < kFewest) return false;
  collectMeans();
  const std::size_t lag = means_.size() / 4, pairs = means_.size() - lag;
  std::size_t falls = 0;
  double way = 0.0;
  for (std::size_t i = 1; i < means_.size(); ++i)
  {
    way += std::abs(means_[i] - means_[i - 1]);
    falls += i >= lag && means_[i] < means_[i - lag];
  }
  return static_cast<double>(std::max(falls, pairs - falls)) < kLeastMajority * static_cast<double>(pairs) ||
         way > kLongestWay * (highest_ - lowest_);
}

/// The mean scatter within a ring against the spacing of the rings.
bool RingOrder::canBeSorted() const
{
  return seen_ > 1 && scatter_ < 0.5 * (highest_ - lowest_) / (seen_ - 1);
}

bool RingOrder::areDistinct() const
{
  if (!canBeSorted()) return false;
  collectMeans();
  std::sort(means_.begin(), means_.end());
  std::size_t apart = 0;
  for (std::size_t i = 1; i < means_.size(); ++i)
    apart += means_[i] - means_[i - 1] > std::max(kLeastSpacing, scatter_);
  return 5 * apart >= 4 * (means_.size() - 1);
}

std::uint32_t RingOrder::returns() const
{
  return std::accumulate(rings_.begin(), rings_.end(), 0U, [](std::uint32_t n, const Ring& r) { return n + r.count; });
}

bool RingOrder::shareElevations() const
{
  if (seen_ < 2 || returns() < kFewest || areOrdered()) return false;
  return scatter_ < 0.5 * std::max((highest_ - lowest_) / (seen_ - 1), kLeastSpacing);
}

bool RingOrder::tellsNothing() const
{
  constexpr double kNoVariance = 4e-4;  // of the sine, squared: a degree
  double within = 0.0, sum = 0.0, sum_of_squares = 0.0;
  std::uint32_t count = 0;
  for (const Ring& ring : rings_)
  {
    within += ring.variance * ring.count;
    sum += ring.mean * ring.count;
    sum_of_squares += (ring.variance + ring.mean * ring.mean) * ring.count;
    count += ring.count;
  }
  if (seen_ < 2 || count < kFewest || count < 4 * static_cast<std::uint32_t>(seen_)) return false;
  const double whole = (sum_of_squares - sum * sum / count) / (count - 1);
  return whole > kNoVariance && within / (count - static_cast<std::uint32_t>(seen_)) > 0.95 * whole;
}

void RingOrder::sortByElevation()
{
  elevation_.resize(rings_.size());
  double before = highest_;
  for (std::size_t ring = 0; ring < rings_.size(); ++ring)
    before = elevation_[ring] = rings_[ring].count > 0 ? rings_[ring].mean : before;
  ring_of_row_.resize(rings_.size());
  std::iota(ring_of_row_.begin(), ring_of_row_.end(), 0U);
  std::sort(ring_of_row_.begin(), ring_of_row_.end(),
            [this](std::uint32_t a, std::uint32_t b)
            { return elevation_[a] != elevation_[b] ? elevation_[a] > elevation_[b] : a < b; });
  for (std::uint32_t row = 0; row < ring_of_row_.size(); ++row) row_of_ring_[ring_of_row_[row]] = row;
}
}  // namespace lidar_panoptic_clustering
