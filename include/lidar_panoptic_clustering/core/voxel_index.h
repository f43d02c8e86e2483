#pragma once

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

/// Numbers the occupied voxels 0, 1, 2 ... in order of insertion: an open-addressing hash table that keeps its memory.
class VoxelIndex
{
public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Empties the index and makes room for `capacity` voxels.
  void reset(std::size_t capacity)
  {
    std::size_t slots = 16;
    while (slots < 2 * capacity) slots *= 2;
    slots_.assign(slots, {0, kNone});
    keys_.clear();
  }

  /// The voxel's number, a new one at its first insertion. At most `capacity` voxels may be inserted.
  std::uint32_t insert(const VoxelKey& key)
  {
    Slot& slot = slots_[locate(key.packed())];
    if (slot.number == kNone)
    {
      slot = {key.packed(), static_cast<std::uint32_t>(keys_.size())};
      keys_.push_back(key);
    }
    return slot.number;
  }

  /// kNone for a voxel that was not inserted.
  std::uint32_t find(const VoxelKey& key) const { return slots_[locate(key.packed())].number; }

  const VoxelKey& operator[](std::uint32_t number) const { return keys_[number]; }
  std::size_t size() const { return keys_.size(); }

private:
  struct Slot
  {
    std::uint64_t key;
    std::uint32_t number;
  };

  std::size_t locate(std::uint64_t key) const
  {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (key * 0x9E3779B97F4A7C15ULL >> 20) & mask;
    while (slots_[at].number != kNone && slots_[at].key != key) at = (at + 1) & mask;
    return at;
  }

  std::vector<Slot> slots_;
  std::vector<VoxelKey> keys_;
};
}  // namespace lidar_panoptic_clustering
