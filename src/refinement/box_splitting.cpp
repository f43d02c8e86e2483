#include "lidar_panoptic_clustering/refinement/box_splitting.h"

#include <algorithm>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kFewestPoints = 10;
constexpr std::uint32_t kSmallestShare = 10;  // one in ten
constexpr int kFinest = 2;
}  // namespace

std::uint32_t BoxSplitter::split(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float reach,
                                 int& tenths, std::vector<std::uint32_t>& part)
{
  const std::uint32_t fewest = std::max(kFewestPoints, count / kSmallestShare);
  if (count < 2 * kFewestPoints || tenths < kFinest) return 1;
  // what hangs together at the finest distance does at the others too: a rest too small leaves nothing to part
  link(scan, things, count, 0.1F * static_cast<float>(kFinest) * reach);
  countSizeable(fewest);
  if (count - *std::max_element(size_of_.begin(), size_of_.end()) < fewest) return 1;
  for (; tenths >= kFinest; --tenths)
  {
    link(scan, things, count, 0.1F * static_cast<float>(tenths) * reach);
    const std::uint32_t parts = countSizeable(fewest);
    if (parts < 2) continue;
    joinRest(scan, things, parts);
    part.resize(count);
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
      cells_.forEach(cell, [&](std::uint32_t k) { part[k] = part_of_[component_of_cell_[cell]]; });
    return parts;
  }
  return 1;
}

/// Finds the components of points linked within `distance` [m].
void BoxSplitter::link(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float distance)
{
  cells_.clear(count);
  for (std::uint32_t k = 0; k < count; ++k)
    cells_.add(scan.points[things[k]].x, scan.points[things[k]].y, 0, distance, k);
  cells_.close();
  distance_.assign(1, distance);
  cells_.findComponents(distance_, component_of_cell_);
}

/// Numbers the components that are large enough; the others have no part yet.
std::uint32_t BoxSplitter::countSizeable(std::uint32_t fewest)
{
  size_of_.assign(cells_.size(), 0);
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
    cells_.forEach(cell, [&](std::uint32_t) { ++size_of_[component_of_cell_[cell]]; });
  part_of_.assign(cells_.size(), kNone);
  std::uint32_t parts = 0;
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    if (size_of_[c] >= fewest) part_of_[c] = parts++;
  return parts;
}

void BoxSplitter::joinRest(const ThingScan& scan, const std::uint32_t* things, std::uint32_t parts)
{
  outline_.assign(cells_.size(), Footprint());
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
    cells_.forEach(cell,
                   [&](std::uint32_t k)
                   {
                     const ThingPoint& p = scan.points[things[k]];
                     outline_[component_of_cell_[cell]].add(p.x, p.y);
                   });
  sizeable_.resize(parts);
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
    if (part_of_[c] != kNone) sizeable_[part_of_[c]] = c;
  for (std::uint32_t c = 0; c < cells_.size(); ++c)
  {
    if (size_of_[c] == 0 || part_of_[c] != kNone) continue;
    const auto gap = [&](std::uint32_t k)
    {
      const Footprint& other = outline_[sizeable_[k]];
      return std::make_tuple(outline_[c].gapTo(other).squaredDistance(), other.minX(), other.minY());
    };
    std::uint32_t nearest = 0;
    for (std::uint32_t k = 1; k < parts; ++k)
      if (gap(k) < gap(nearest)) nearest = k;
    part_of_[c] = nearest;
  }
}
}  // namespace lidar_panoptic_clustering
