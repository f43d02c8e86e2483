#include "lidar_panoptic_clustering/core/instances.h"

#include <algorithm>

namespace lidar_panoptic_clustering
{
void Refinement::refine(const ThingScan& scan, const std::vector<std::uint32_t>& component, Instances& instances)
{
  const std::size_t n = scan.size();
  size_of_.assign(n, 0);
  for (const std::uint32_t c : component) ++size_of_[c];

  id_of_.assign(n, 0);
  instances.id.resize(n);
  instances.objects.clear();
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::uint32_t c = component[i];
    if (id_of_[c] == 0 && size_of_[c] >= static_cast<std::uint32_t>(config_.min_points))
    {
      instances.objects.emplace_back();
      id_of_[c] = static_cast<std::uint32_t>(instances.objects.size());
    }
    instances.id[i] = id_of_[c];
  }

  const std::size_t classes = scan.class_count;
  votes_.assign(instances.count() * classes, 0);
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::uint32_t id = instances.id[i];
    if (id == 0) continue;
    auto& object = instances.objects[id - 1];
    ++object.point_count;
    object.x += scan.points[i].x, object.y += scan.points[i].y, object.z += scan.points[i].z;
    ++votes_[(id - 1) * classes + scan.class_index[i]];
  }
  for (std::size_t k = 0; k < instances.count(); ++k)
  {
    auto& object = instances.objects[k];
    const float scale = 1.0F / static_cast<float>(object.point_count);
    object.x *= scale, object.y *= scale, object.z *= scale;
    const auto votes = votes_.begin() + static_cast<std::ptrdiff_t>(k * classes);
    object.class_index =
        static_cast<ClassIndex>(std::max_element(votes, votes + static_cast<std::ptrdiff_t>(classes)) - votes);
  }
}
}  // namespace lidar_panoptic_clustering
