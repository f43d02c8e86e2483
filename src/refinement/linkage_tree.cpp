#include "lidar_panoptic_clustering/refinement/linkage_tree.h"

#include <numeric>

namespace lidar_panoptic_clustering
{
namespace
{
float tenthsOf(int tenths, float reach)
{
  return 0.1F * static_cast<float>(tenths) * reach;
}
}  // namespace

void LinkageTree::build(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float reach)
{
  reach_ = reach;
  cells_.clear(tenthsOf(kFinest, reach));
  for (std::uint32_t k = 0; k < count; ++k) cells_.add(scan.points[things[k]].x, scan.points[things[k]].y, k);
  cells_.close();
  cells_.link(tenthsOf(kFinest, reach));

  const auto& component = cells_.components();
  leaf_of_cell_.assign(cells_.size(), kNone);
  leaf_of_point_.resize(count);
  size_.clear();
  cell_of_leaf_.clear();
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const std::uint32_t cell = component[cells_.cellOf(k)];
    std::uint32_t& leaf = leaf_of_cell_[cell];
    if (leaf == kNone)
    {
      leaf = size();
      size_.push_back(0);
      cell_of_leaf_.push_back(cell);
    }
    leaf_of_point_[k] = leaf;
    ++size_[leaf];
  }
  linked_ = kFinest;
  is_whole_ = size() == 1;
  component_[kFinest].resize(size());
  std::iota(component_[kFinest].begin(), component_[kFinest].end(), 0U);
}

const std::vector<std::uint32_t>& LinkageTree::components(int tenths)
{
  while (linked_ < tenths) linkNext();
  return component_[static_cast<std::size_t>(tenths)];
}

void LinkageTree::linkNext()
{
  auto& component = component_[static_cast<std::size_t>(++linked_)];
  component.assign(size(), 0);
  if (is_whole_) return;
  cells_.link(tenthsOf(linked_, reach_));
  leaf_of_cell_.assign(cells_.size(), kNone);
  is_whole_ = true;
  for (std::uint32_t leaf = 0; leaf < size(); ++leaf)
  {
    std::uint32_t& first = leaf_of_cell_[cells_.components()[cell_of_leaf_[leaf]]];
    if (first == kNone) first = leaf;
    component[leaf] = first;
    is_whole_ = is_whole_ && first == 0;
  }
}
}  // namespace lidar_panoptic_clustering
