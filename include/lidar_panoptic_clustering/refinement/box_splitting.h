#pragma once

#include "lidar_panoptic_clustering/core/thing_scan.h"
#include "lidar_panoptic_clustering/geometry/footprint.h"
#include "lidar_panoptic_clustering/refinement/linkage_tree.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Parts one object where its points hang together least in bird's-eye view.
///
/// The link distance is lowered by tenths of `reach`, from nine down to two, until two or more sizeable parts are left:
/// a tenth of the object's points each, and at least ten. What is not in one of them joins the nearest of them
/// (outline to outline). A part can be parted again: a part is a set of leaves of the object's LinkageTree, which is
/// built once.
///
/// The points are looked at once, whatever the number of parts; each parting is linear in its leaves, but for those
/// that belong to no sizeable part, times the parts. Keeps its memory.
class BoxSplitter
{
public:
  static constexpr int kCoarsest = LinkageTree::kCoarsest;  ///< tenths of the reach to begin with

  /// `things`: the object's `count` points, indices into the scan, in rising order. Returns whether it can be parted at
  /// all; if not, nothing else may be called. The things stay where they are until the next call.
  bool begin(const ThingScan& scan, const std::uint32_t* things, std::uint32_t count, float reach);

  /// The object's leaves; a set of them is always given in rising order.
  const LinkageTree& leaves() const { return tree_; }
  /// A leaf's outline; once the object was parted.
  const OrderedFootprint& outline(std::uint32_t leaf) const { return outline_[leaf]; }

  /// Parts what `count` leaves make together. `tenths`: where to begin, at most kCoarsest; becomes the distance found,
  /// where the parts hang together, so that each of them need only be looked at below it. Returns the number of parts,
  /// 1 where it hangs together; else `part` holds each leaf's part, 0..n-1, parallel to `leaves`. Parts are numbered by
  /// their components' first points.
  std::uint32_t split(const std::uint32_t* leaves, std::uint32_t count, int& tenths, std::vector<std::uint32_t>& part);

private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  bool isOneAtTheFinest(const std::uint32_t* leaves, std::uint32_t count, std::uint32_t& points) const;
  std::uint32_t countSizeable(const std::uint32_t* leaves, std::uint32_t count, int tenths, std::uint32_t fewest);
  void findOutlines();
  void joinRest(const std::uint32_t* leaves, std::uint32_t count, int tenths);
  std::uint32_t nearestPart(const Footprint& outline) const;

  LinkageTree tree_;
  const ThingScan* scan_ = nullptr;  ///< what begin() was given
  const std::uint32_t* things_ = nullptr;
  std::uint32_t count_ = 0;
  std::vector<OrderedFootprint> outline_;         ///< by leaf; empty until the object is parted
  std::vector<std::uint32_t> size_of_, part_of_;  ///< by component's first leaf
  std::vector<OrderedFootprint> whole_;           ///< by component's first leaf: its outline
  std::vector<std::uint32_t> sizeable_;           ///< by part: its component
};
}  // namespace lidar_panoptic_clustering
