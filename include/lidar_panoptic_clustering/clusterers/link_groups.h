#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The thing points of each link key, for algorithms that take one key after the other.
class LinkGroups
{
public:
  /// Linear; keeps its memory.
  void build(const ThingScan& scan)
  {
    begin_.assign(scan.link_count + 1, 0);
    for (const std::uint8_t link : scan.link) ++begin_[link + 1U];
    for (std::uint32_t link = 0; link < scan.link_count; ++link) begin_[link + 1] += begin_[link];
    things_.resize(scan.size());
    next_.assign(begin_.begin(), begin_.end());
    for (std::uint32_t i = 0; i < scan.size(); ++i) things_[next_[scan.link[i]]++] = i;
  }

  /// Number of link keys, those without points included.
  std::size_t count() const { return begin_.size() - 1; }
  /// Indices into the ThingScan, ascending.
  const std::uint32_t* begin(std::size_t group) const { return things_.data() + begin_[group]; }
  /// Behind the last one.
  const std::uint32_t* end(std::size_t group) const { return things_.data() + begin_[group + 1]; }
  /// Points of a key.
  std::size_t size(std::size_t group) const { return begin_[group + 1] - begin_[group]; }

private:
  std::vector<std::uint32_t> begin_, next_, things_;
};
}  // namespace lidar_panoptic_clustering
