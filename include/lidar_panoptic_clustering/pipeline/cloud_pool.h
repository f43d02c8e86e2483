#pragma once

#include "lidar_panoptic_clustering/core/point_types.h"

#include <cstddef>
#include <memory>

namespace lidar_panoptic_clustering
{
/// Output clouds that are used again: a cloud comes back when its last reader lets go of it, in whatever thread and
/// whenever that is, after the pool itself is gone too (then its memory is freed).
///
/// A cloud that comes back keeps its points, so that a frame of the same size is written into pages touched before, and
/// nothing is set to zero first: whoever takes one has to write all of it. Slow or many readers get new clouds, as many
/// as they hold; of those that come back at most `most_kept` are kept, the rest is freed. take() allocates nothing
/// where a cloud has come back: the pointer's count lies beside the cloud and comes back with it, after the last weak
/// pointer.
///
/// Safe to be used from several threads.
template <class Cloud>
class CloudPool
{
public:
  /// Keeps up to `most_kept` idle clouds.
  explicit CloudPool(std::size_t most_kept = 4);
  ~CloudPool();
  CloudPool(const CloudPool&) = delete;
  CloudPool& operator=(const CloudPool&) = delete;

  /// A cloud that nobody else holds; its contents are those of some earlier use.
  typename Cloud::Ptr take();

  /// Clouds that have come back and wait.
  std::size_t idle() const;
  /// Clouds made so far, for tests: stands still in steady state.
  std::size_t made() const;

private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

extern template class CloudPool<PanopticCloud>;
extern template class CloudPool<LabelledCloud>;
}  // namespace lidar_panoptic_clustering
