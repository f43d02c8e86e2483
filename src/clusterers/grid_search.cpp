#include "clusterers/grid_search.h"

#include <pcl/common/point_tests.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
/// As FLANN sums it up.
float squaredDistance(const pcl::PointXYZ& p, float x, float y, float z)
{
  const float dx = p.x - x, dy = p.y - y, dz = p.z - z;
  return dx * dx + dy * dy + dz * dz;
}
}  // namespace

GridSearch::GridSearch(double cell, HandOut hand_out)
    : Search("GridSearch", false), cells_per_m_(1.0 / cell), hand_out_(hand_out)
{
  if (!(cell > 0.0)) throw std::invalid_argument("cells of a grid search have to have a size");
}

VoxelKey GridSearch::keyOf(const pcl::PointXYZ& point) const
{
  const auto cell = [this](float metres) { return static_cast<std::int32_t>(std::floor(metres * cells_per_m_)); };
  return {cell(point.x), cell(point.y), cell(point.z)};
}

GridSearch::BoolFromPcl115 GridSearch::setInputCloud(const PointCloudConstPtr& cloud, const IndicesConstPtr& indices)
{
  input_ = cloud;
  indices_ = indices;
  const auto count = static_cast<std::uint32_t>(indices ? indices->size() : cloud->size());
  const auto indexOf = [&](std::uint32_t k) { return indices ? (*indices)[k] : static_cast<Index>(k); };
  const auto pointAt = [&](std::uint32_t k) -> const pcl::PointXYZ& { return (*cloud)[indexOf(k)]; };
  index_.reset(index_.size());
  cells_.clear();
  cell_of_point_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k)
  {
    cell_of_point_[k] = kNone;
    if (!pcl::isFinite(pointAt(k))) continue;
    const std::uint32_t cell = cell_of_point_[k] = index_.insert(keyOf(pointAt(k)));
    if (cell == cells_.size()) cells_.push_back({0, 0});
    ++cells_[cell].end;
  }
  std::uint32_t begin = 0;
  for (Cell& cell : cells_)
  {
    const std::uint32_t size = cell.end;
    cell.begin = cell.end = begin;
    begin += size;
  }
  entries_.resize(begin);
  for (std::uint32_t k = 0; k < count; ++k)
    if (cell_of_point_[k] != kNone)
    {
      const pcl::PointXYZ& p = pointAt(k);
      entries_[cells_[cell_of_point_[k]].end++] = {p.x, p.y, p.z, indexOf(k)};
    }
  around_.resize(cells_.size() * kAround);
  return static_cast<BoolFromPcl115>(true);
}

int GridSearch::radiusSearch(const pcl::PointXYZ& point, double radius, pcl::Indices& k_indices,
                             std::vector<float>& k_sqr_distances, unsigned int max_nn) const
{
  k_indices.clear();
  k_sqr_distances.clear();
  if (!pcl::isFinite(point) || !(radius > 0.0)) return 0;
  const auto squared_radius = static_cast<float>(radius * radius);
  const VoxelKey key = keyOf(point);
  const double reach = radius * cells_per_m_;
  const std::uint32_t own = index_.find(key);
  if (own != kNone && reach <= 1.0)
    searchAround(own, point, squared_radius, k_indices, k_sqr_distances);
  else if (std::pow(2.0 * reach + 3.0, 3.0) > static_cast<double>(cells_.size()))
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
      searchCell(cell, point, squared_radius, k_indices, k_sqr_distances);
  else
  {
    const int far = static_cast<int>(std::ceil(reach));
    for (int dx = -far; dx <= far; ++dx)
      for (int dy = -far; dy <= far; ++dy)
        for (int dz = -far; dz <= far; ++dz)
          if (const std::uint32_t cell = index_.find({key.x + dx, key.y + dy, key.z + dz}); cell != kNone)
            searchCell(cell, point, squared_radius, k_indices, k_sqr_distances);
  }
  order(max_nn, k_indices, k_sqr_distances);
  return static_cast<int>(k_indices.size());
}

void GridSearch::searchCell(std::uint32_t cell, const pcl::PointXYZ& point, float squared_radius, pcl::Indices& indices,
                            std::vector<float>& distances) const
{
  std::uint32_t& end = cells_[cell].end;
  for (std::uint32_t i = cells_[cell].begin; i < end;)
  {
    Entry& entry = entries_[i];
    const float squared = squaredDistance(point, entry.x, entry.y, entry.z);
    if (!(squared < squared_radius))
    {
      ++i;
      continue;
    }
    indices.push_back(entry.index);
    distances.push_back(squared);
    if (hand_out_ == kOnce)
      std::swap(entry, entries_[--end]);
    else
      ++i;
  }
}

/// The 27 cells about a cell; those that have nothing left are struck off its list.
void GridSearch::searchAround(std::uint32_t cell, const pcl::PointXYZ& point, float squared_radius,
                              pcl::Indices& indices, std::vector<float>& distances) const
{
  if (cells_[cell].around_count == 255) findAround(cell);
  std::uint32_t* const around = &around_[std::size_t{cell} * kAround];
  for (std::uint8_t k = 0; k < cells_[cell].around_count;)
  {
    searchCell(around[k], point, squared_radius, indices, distances);
    if (cells_[around[k]].begin == cells_[around[k]].end)
      around[k] = around[--cells_[cell].around_count];
    else
      ++k;
  }
}

void GridSearch::findAround(std::uint32_t cell) const
{
  const VoxelKey key = index_[cell];
  std::uint8_t count = 0;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dz = -1; dz <= 1; ++dz)
        if (const std::uint32_t other = index_.find({key.x + dx, key.y + dy, key.z + dz}); other != kNone)
          around_[std::size_t{cell} * kAround + count++] = other;
  cells_[cell].around_count = count;
}

int GridSearch::nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& k_indices,
                               std::vector<float>& k_sqr_distances) const
{
  k_indices.clear();
  k_sqr_distances.clear();
  if (!pcl::isFinite(point) || k <= 0) return 0;
  for (const Entry& entry : entries_)
  {
    k_indices.push_back(entry.index);
    k_sqr_distances.push_back(squaredDistance(point, entry.x, entry.y, entry.z));
  }
  order(static_cast<unsigned int>(k), k_indices, k_sqr_distances);
  return static_cast<int>(k_indices.size());
}

/// Leaves the nearest `most` (0: all), in order of distance where that was asked for.
void GridSearch::order(unsigned int most, pcl::Indices& indices, std::vector<float>& distances) const
{
  const bool is_cut = most > 0 && most < indices.size();
  if (!sorted_results_ && !is_cut) return;
  std::vector<std::pair<float, Index>> pairs;
  for (std::size_t k = 0; k < indices.size(); ++k) pairs.emplace_back(distances[k], indices[k]);
  std::sort(pairs.begin(), pairs.end());
  if (is_cut) pairs.resize(most);
  indices.clear();
  distances.clear();
  for (const auto& [distance, index] : pairs)
  {
    indices.push_back(index);
    distances.push_back(distance);
  }
}
}  // namespace lidar_panoptic_clustering
