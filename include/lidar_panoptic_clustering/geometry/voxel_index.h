#pragma once

#include "lidar_panoptic_clustering/core/language.h"

#include <cstdint>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A voxel's place on the grid; coordinates of up to 20 bits and sign each.
struct VoxelKey
{
  std::int32_t x, y, z;

  std::uint64_t packed() const
  {
    constexpr std::uint64_t kMask = 0x1FFFFF;
    return (static_cast<std::uint64_t>(x) & kMask) << 42 | (static_cast<std::uint64_t>(y) & kMask) << 21 |
           (static_cast<std::uint64_t>(z) & kMask);
  }
};

/// A cell's place in bird's-eye view, on one of 256 layers; coordinates of up to 27 bits and sign each.
struct PlanarKey
{
  std::int32_t x, y, layer;

  std::uint64_t packed() const
  {
    constexpr std::uint64_t kMask = 0xFFFFFFF;
    return static_cast<std::uint64_t>(layer) << 56 | (static_cast<std::uint64_t>(y) & kMask) << 28 |
           (static_cast<std::uint64_t>(x) & kMask);
  }
};

/// Numbers the occupied voxels 0, 1, 2 ... in order of insertion: an open-addressing hash table that keeps its memory.
///
/// Emptying it costs nothing: a slot counts only while it bears the present epoch.
template <class Key>
class CellIndex
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Empties the index, with room for `capacity` voxels; it grows by itself when there are more.
  void reset(std::size_t capacity = 0)
  {
    keys_.clear();
    std::size_t slots = kFewestSlots;
    while (slots < 2 * capacity) slots *= 2;
    useSlots(slots);
  }

  /// The voxel's number, a new one at its first insertion.
  std::uint32_t insert(const Key& key)
  {
    std::size_t at = locate(key.packed());
    if (slots_[at].epoch == epoch_) return slots_[at].number;
    if (2 * keys_.size() > mask_)
    {
      grow();
      at = locate(key.packed());
    }
    slots_[at] = {key.packed(), static_cast<std::uint32_t>(keys_.size()), epoch_};
    keys_.push_back(key);
    return slots_[at].number;
  }

  /// kNone for a voxel that was not inserted.
  std::uint32_t find(const Key& key) const
  {
    const Slot& slot = slots_[locate(key.packed())];
    return slot.epoch == epoch_ ? slot.number : kNone;
  }

  const Key& operator[](std::uint32_t number) const { return keys_[number]; }
  std::size_t size() const { return keys_.size(); }

private:
  static constexpr std::size_t kFewestSlots = 64;

  struct Slot
  {
    std::uint64_t key;
    std::uint32_t number;
    std::uint32_t epoch;
  };

  /// Empties the first `count` slots, a power of two, and uses only those: few voxels stay close together in memory.
  void useSlots(std::size_t count)
  {
    if (slots_.size() < count || epoch_ == 0xFFFFFFFF)
    {
      slots_.assign(count > slots_.size() ? count : slots_.size(), {0, 0, 0});
      epoch_ = 0;
    }
    ++epoch_;
    mask_ = count - 1;
    for (shift_ = 64; count > 1; count /= 2) --shift_;
  }

  void grow()
  {
    useSlots(2 * (mask_ + 1));
    for (std::uint32_t number = 0; number < keys_.size(); ++number)
    {
      const std::uint64_t key = keys_[number].packed();
      slots_[locate(key)] = {key, number, epoch_};
    }
  }

  std::size_t locate(std::uint64_t key) const
  {
    // Fibonacci hashing: of a product's bits only the highest depend on all of the key's
    std::size_t at = key * 0x9E3779B97F4A7C15ULL >> shift_;
    while (slots_[at].epoch == epoch_ && slots_[at].key != key) at = (at + 1) & mask_;
    return at;
  }

  std::vector<Slot> slots_ = std::vector<Slot>(kFewestSlots, Slot{0, 0, 0});
  std::vector<Key> keys_;
  std::uint32_t epoch_ = 1;  ///< above that of every slot not in use
  std::size_t mask_ = kFewestSlots - 1;
  int shift_ = 58;  ///< from 64 bits down to those of mask_
};

using VoxelIndex = CellIndex<VoxelKey>;
using PlanarIndex = CellIndex<PlanarKey>;
}  // namespace lidar_panoptic_clustering
