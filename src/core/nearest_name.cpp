#include "lidar_panoptic_clustering/core/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace lidar_panoptic_clustering
{
namespace
{
/// Of at least four letters: shorter ones are parts of anything.
bool isPart(const std::string& part, const std::string& whole)
{
  return part.size() >= 4 && whole.find(part) != std::string::npos;
}
}  // namespace

std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      const std::size_t exchanged = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({exchanged, row[j + 1] + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string nearestName(const std::string& name, const std::vector<std::string>& names)
{
  std::string nearest, containing;
  std::size_t least = 0;
  for (const std::string& other : names)
  {
    const std::size_t distance = editDistance(name, other);
    if (3 * distance <= std::max(name.size(), other.size()) && (nearest.empty() || distance < least))
      nearest = other, least = distance;
    if (containing.empty() && (isPart(name, other) || isPart(other, name))) containing = other;
  }
  return nearest.empty() ? containing : nearest;
}
}  // namespace lidar_panoptic_clustering
