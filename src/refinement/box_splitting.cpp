#include "lidar_panoptic_clustering/refinement/box_splitting.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kFewestPoints = 10;
constexpr std::uint32_t kSmallestShare = 10;  // one in ten

std::uint32_t fewestOf(std::uint32_t points)
{
  return std::max(kFewestPoints, points / kSmallestShare);
}
}  // namespace

bool BoxSplitter::begin(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float reach)
{
  if (count < 2 * kFewestPoints) return false;
  tree_.build(scan, things, count, reach);
  std::uint32_t largest = 0;
  for (std::uint32_t leaf = 0; leaf < tree_.size(); ++leaf) largest = std::max(largest, tree_.pointsOf(leaf));
  if (count - largest < fewestOf(count)) return false;
  scan_ = &scan, things_ = things, count_ = count;
  outline_.clear();
  size_of_.assign(tree_.size(), 0);
  part_of_.resize(tree_.size());
  whole_.resize(tree_.size());
  return true;
}

void BoxSplitter::findOutlines()
{
  if (!outline_.empty()) return;
  outline_.resize(tree_.size());
  for (std::uint32_t k = 0; k < count_; ++k)
  {
    const ThingPoint& p = scan_->points[things_[k]];
    outline_[tree_.leafOf(k)].add(p.x, p.y, k);
  }
}

/// What hangs together at the finest distance does at the others too: a rest too small leaves nothing to part.
bool BoxSplitter::isOneAtTheFinest(const std::uint32_t* leaves, std::uint32_t count, std::uint32_t& points) const
{
  std::uint32_t largest = 0;
  points = 0;
  for (std::uint32_t k = 0; k < count; ++k)
  {
    largest = std::max(largest, tree_.pointsOf(leaves[k]));
    points += tree_.pointsOf(leaves[k]);
  }
  return points < 2 * kFewestPoints || points - largest < fewestOf(points);
}

std::uint32_t BoxSplitter::split(const std::uint32_t* leaves, std::uint32_t count, int& tenths,
                                 std::vector<std::uint32_t>& part)
{
  std::uint32_t points = 0;
  if (tenths < LinkageTree::kFinest || isOneAtTheFinest(leaves, count, points)) return 1;
  for (; tenths >= LinkageTree::kFinest; --tenths)
  {
    const std::uint32_t parts = countSizeable(leaves, count, tenths, fewestOf(points));
    if (parts < 2) continue;
    findOutlines();
    joinRest(leaves, count, tenths);
    const auto& component = tree_.components(tenths);
    part.resize(count);
    for (std::uint32_t k = 0; k < count; ++k) part[k] = part_of_[component[leaves[k]]];
    return parts;
  }
  return 1;
}

/// Numbers the components that are large enough; the others have no part yet.
std::uint32_t BoxSplitter::countSizeable(const std::uint32_t* leaves, std::uint32_t count, int tenths,
                                         std::uint32_t fewest)
{
  const auto& component = tree_.components(tenths);
  for (std::uint32_t k = 0; k < count; ++k) size_of_[component[leaves[k]]] = 0;
  for (std::uint32_t k = 0; k < count; ++k) size_of_[component[leaves[k]]] += tree_.pointsOf(leaves[k]);
  sizeable_.clear();
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const std::uint32_t c = component[leaves[k]];
    if (c != leaves[k]) continue;
    part_of_[c] = size_of_[c] < fewest ? kNone : static_cast<std::uint32_t>(sizeable_.size());
    if (part_of_[c] != kNone) sizeable_.push_back(c);
  }
  return static_cast<std::uint32_t>(sizeable_.size());
}

void BoxSplitter::joinRest(const std::uint32_t* leaves, std::uint32_t count, int tenths)
{
  const auto& component = tree_.components(tenths);
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const std::uint32_t leaf = leaves[k], c = component[leaf];
    if (c == leaf)
      whole_[c] = outline_[leaf];
    else
      whole_[c].add(outline_[leaf]);
  }
  for (std::uint32_t k = 0; k < count; ++k)
    if (component[leaves[k]] == leaves[k] && part_of_[leaves[k]] == kNone)
      part_of_[leaves[k]] = nearestPart(whole_[leaves[k]].outline());
}

/// By gap, then by where the part begins.
std::uint32_t BoxSplitter::nearestPart(const Footprint& outline) const
{
  constexpr float kRounding = 1e-3F;  // of the gap, and [m]
  const auto gap = [&](std::uint32_t k)
  {
    const Footprint& other = whole_[sizeable_[k]].outline();
    return std::make_tuple(outline.gapTo(other).squaredDistance(), other.minX(), other.minY());
  };
  std::uint32_t nearest = 0;
  auto least = gap(0);
  for (std::uint32_t k = 1; k < sizeable_.size(); ++k)
  {
    const float distance = std::sqrt(std::get<0>(least));
    if (!outline.mayBeCloser(whole_[sizeable_[k]].outline(), distance + kRounding * (distance + 1.0F))) continue;
    if (const auto found = gap(k); found < least) nearest = k, least = found;
  }
  return nearest;
}
}  // namespace lidar_panoptic_clustering
