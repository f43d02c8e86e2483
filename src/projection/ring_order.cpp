#include "lidar_panoptic_clustering/projection/ring_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar_panoptic_clustering
{
void RingOrder::look(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions,
                     std::uint32_t rings)
{
  sum(scan, directions, rings);
  countSteps();
  row_of_ring_.resize(rings);
  if (!isMonotone() && canBeSorted()) return sortByElevation();
  for (std::uint32_t ring = 0; ring < rings; ++ring) row_of_ring_[ring] = falls_ >= rises_ ? ring : rings - 1 - ring;
}

void RingOrder::sum(const std::vector<ScanPoint>& scan, const std::vector<PointDirection>& directions,
                    std::uint32_t rings)
{
  rings_.assign(rings, Ring());
  // a small scan is looked at whole
  const std::size_t step = scan.size() < 64 * std::size_t{rings} ? 1 : 13;
  for (std::size_t i = 0; i < scan.size(); i += step)
  {
    if (std::isnan(directions[i].azimuth)) continue;
    const ScanPoint& p = scan[i];
    const double sine = p.z / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    Ring& ring = rings_[directions[i].row];
    ring.sum += sine;
    ring.sum_of_squares += sine * sine;
    ++ring.count;
  }
}

void RingOrder::countSteps()
{
  falls_ = rises_ = 0;
  largest_fall_ = largest_rise_ = 0.0;
  const Ring* last = nullptr;
  for (const Ring& ring : rings_)
  {
    if (ring.count == 0) continue;
    const double mean = ring.mean();
    if (last == nullptr) lowest_ = highest_ = mean;
    lowest_ = std::min(lowest_, mean), highest_ = std::max(highest_, mean);
    if (last != nullptr)
    {
      const double step = mean - last->mean();
      falls_ += step<0.0, rises_ += step> 0.0;
      largest_fall_ = std::max(largest_fall_, -step), largest_rise_ = std::max(largest_rise_, step);
    }
    last = &ring;
  }
}

bool RingOrder::isMonotone() const
{
  const int steps = falls_ + rises_;
  if (steps == 0) return false;
  const double back = falls_ > rises_ ? largest_rise_ : largest_fall_;
  return 10 * std::max(falls_, rises_) >= 9 * steps && back < 0.25 * (highest_ - lowest_);
}

/// The mean scatter within a ring against the spacing of the rings.
bool RingOrder::canBeSorted() const
{
  double scatter = 0.0;
  int seen = 0;
  for (const Ring& ring : rings_)
  {
    if (ring.count == 0) continue;
    scatter += std::sqrt(std::max(0.0, ring.sum_of_squares / ring.count - ring.mean() * ring.mean()));
    ++seen;
  }
  return seen > 1 && scatter / seen < 0.5 * (highest_ - lowest_) / (seen - 1);
}

void RingOrder::sortByElevation()
{
  elevation_.resize(rings_.size());
  double before = highest_;
  for (std::size_t ring = 0; ring < rings_.size(); ++ring)
    before = elevation_[ring] = rings_[ring].count > 0 ? rings_[ring].mean() : before;
  ring_of_row_.resize(rings_.size());
  std::iota(ring_of_row_.begin(), ring_of_row_.end(), 0U);
  std::sort(ring_of_row_.begin(), ring_of_row_.end(),
            [this](std::uint32_t a, std::uint32_t b)
            { return elevation_[a] != elevation_[b] ? elevation_[a] > elevation_[b] : a < b; });
  for (std::uint32_t row = 0; row < ring_of_row_.size(); ++row) row_of_ring_[ring_of_row_[row]] = row;
}
}  // namespace lidar_panoptic_clustering
