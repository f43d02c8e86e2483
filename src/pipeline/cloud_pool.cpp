#include "lidar_panoptic_clustering/pipeline/cloud_pool.h"

#include <mutex>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What outlives the pool as long as a reader holds a cloud.
template <class Cloud>
struct CloudPool<Cloud>::Shared
{
  /// A cloud, and room for the count of the pointer to it.
  struct Slot
  {
    static constexpr std::size_t kCountBytes = 192;  // a std:: or boost::shared_ptr's takes about half

    Cloud cloud;
    alignas(std::max_align_t) unsigned char count[kCountBytes];
    EIGEN_MAKE_ALIGNED_OPERATOR_NEW
  };
  using SlotPtr = std::unique_ptr<Slot>;

  explicit Shared(std::size_t most) : most_kept(most) { idle.reserve(most); }

  SlotPtr take()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (idle.empty())
    {
      ++made;
      return std::make_unique<Slot>();
    }
    SlotPtr slot = std::move(idle.back());  // the one that came back last is the likeliest to be in the cache
    idle.pop_back();
    return slot;
  }

  /// What is not kept is freed with the argument, after the lock.
  void giveBack(SlotPtr slot)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!is_closed && idle.size() < most_kept) idle.push_back(std::move(slot));
  }

  mutable std::mutex mutex;
  std::vector<SlotPtr> idle;
  const std::size_t most_kept;
  std::size_t made = 0;
  bool is_closed = false;
};

namespace
{
/// Puts the count of a pointer into the cloud's slot. The count goes when nobody, not even a weak pointer, refers to
/// the cloud any more: only then the slot comes back.
template <class T, class Shared>
class CountAllocator
{
public:
  using value_type = T;
  template <class U>
  struct rebind
  {
    using other = CountAllocator<U, Shared>;
  };

  CountAllocator(std::shared_ptr<Shared> shared, typename Shared::Slot* slot) : shared_(std::move(shared)), slot_(slot)
  {
  }
  template <class U>
  CountAllocator(const CountAllocator<U, Shared>& other) : shared_(other.shared()), slot_(other.slot())
  {
  }

  T* allocate(std::size_t)
  {
    static_assert(sizeof(T) <= Shared::Slot::kCountBytes && alignof(T) <= alignof(std::max_align_t));
    return reinterpret_cast<T*>(slot_->count);
  }
  void deallocate(T*, std::size_t) { shared_->giveBack(typename Shared::SlotPtr(slot_)); }

  const std::shared_ptr<Shared>& shared() const { return shared_; }
  typename Shared::Slot* slot() const { return slot_; }
  template <class U>
  bool operator==(const CountAllocator<U, Shared>& other) const
  {
    return slot_ == other.slot();
  }
  template <class U>
  bool operator!=(const CountAllocator<U, Shared>& other) const
  {
    return slot_ != other.slot();
  }

private:
  std::shared_ptr<Shared> shared_;
  typename Shared::Slot* slot_;
};

/// The cloud stays as it is for the next one who takes it.
struct LeaveIt
{
  template <class T>
  void operator()(T*) const
  {
  }
};
}  // namespace

template <class Cloud>
CloudPool<Cloud>::CloudPool(std::size_t most_kept) : shared_(std::make_shared<Shared>(most_kept))
{
}

template <class Cloud>
CloudPool<Cloud>::~CloudPool()
{
  std::vector<typename Shared::SlotPtr> freed;  // after the lock
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  shared_->is_closed = true;
  freed.swap(shared_->idle);
}

template <class Cloud>
typename Cloud::Ptr CloudPool<Cloud>::take()
{
  typename Shared::Slot* const slot = shared_->take().release();
  return typename Cloud::Ptr(&slot->cloud, LeaveIt(), CountAllocator<Cloud, Shared>(shared_, slot));
}

template <class Cloud>
std::size_t CloudPool<Cloud>::idle() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->idle.size();
}

template <class Cloud>
std::size_t CloudPool<Cloud>::made() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->made;
}

template class CloudPool<PanopticCloud>;
template class CloudPool<LabelledCloud>;
}  // namespace lidar_panoptic_clustering
