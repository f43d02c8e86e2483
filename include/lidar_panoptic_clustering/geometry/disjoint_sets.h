#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <numeric>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Union-find over 0..n-1; the smallest member stands for its set. Path halving; near-constant time an operation.
class DisjointSets
{
public:
  /// Makes n sets of one element each. Linear.
  void reset(std::size_t n)
  {
    parent_.resize(n);
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// Makes one more set of one element, and returns that.
  std::uint32_t add()
  {
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    return parent_.back();
  }

  /// The element that stands for the set of i < n.
  std::uint32_t find(std::uint32_t i)
  {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Makes one set of two; the smaller element stands for it.
  void unite(std::uint32_t a, std::uint32_t b)
  {
    a = find(a), b = find(b);
    if (a < b)
      parent_[b] = a;
    else
      parent_[a] = b;
  }

  /// Writes every element's representative. A parent is never larger than its child, so one forward pass does it.
  void flatten(std::vector<std::uint32_t>& representative)
  {
    for (std::uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = parent_[parent_[i]];
    representative.assign(parent_.begin(), parent_.end());
  }

private:
  std::vector<std::uint32_t> parent_;
};
}  // namespace lidar_panoptic_clustering
