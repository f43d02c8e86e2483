#include "lidar_panoptic_clustering/labelling/scan_components.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kColumnReach = 3, kRowReach = 2;

bool hangTogether(const LabelledPoint& a, const LabelledPoint& b, float squared_link)
{
  const auto pa = a.getVector3fMap(), pb = b.getVector3fMap();
  const float squared = (pa - pb).squaredNorm();
  if (squared < squared_link) return true;
  // |a x b| / |a| is their distance across the beam
  constexpr float kSlant = 4.0F;
  return squared * pa.squaredNorm() < kSlant * pa.cross(pb).squaredNorm();
}
}  // namespace

void ScanComponents::find(const LabelledCloud& cloud, const std::vector<float>& height, float above,
                          float link_distance, bool full_turn)
{
  const std::uint32_t rows = cloud.height, columns = cloud.width;
  const float squared_link = link_distance * link_distance;
  sets_.reset(cloud.points.size());
  component_of_.assign(cloud.points.size(), kNone);
  above_.assign(columns, kNone);
  const auto link = [&](std::uint32_t a, std::uint32_t b)
  {
    if (hangTogether(cloud.points[a], cloud.points[b], squared_link)) sets_.unite(a, b);
  };
  for (std::uint32_t row = 0; row < rows; ++row)
  {
    const std::uint32_t begin = row * columns;
    std::uint32_t first = kNone, last = kNone;
    for (std::uint32_t column = 0; column < columns; ++column)
    {
      const std::uint32_t pixel = begin + column;
      if (!(height[pixel] >= above)) continue;
      component_of_[pixel] = 0;
      if (first == kNone) first = pixel;
      if (last != kNone && pixel - last <= kColumnReach) link(pixel, last);
      last = pixel;
      const std::uint32_t up = above_[column];
      if (up != kNone && row - up <= kRowReach) link(pixel, up * columns + column);
      above_[column] = row;
    }
    if (full_turn && first != last && first + columns - last <= kColumnReach) link(first, last);
  }
  gather(cloud, height);
}

void ScanComponents::gather(const LabelledCloud& cloud, const std::vector<float>& height)
{
  components_.clear();
  for (std::uint32_t pixel = 0; pixel < component_of_.size(); ++pixel)
  {
    if (component_of_[pixel] == kNone) continue;
    const std::uint32_t root = sets_.find(pixel);  // the smallest member, so it has been here
    if (root == pixel)
    {
      component_of_[pixel] = static_cast<std::uint32_t>(components_.size());
      components_.emplace_back();
      components_.back().bottom = components_.back().top = height[pixel];
    }
    component_of_[pixel] = component_of_[root];
    ScanComponent& c = components_[component_of_[pixel]];
    const LabelledPoint& p = cloud.points[pixel];
    ++c.point_count;
    if (pixel < cloud.width || std::isnan(height[pixel - cloud.width]))
      c.open_top = c.open_top || pixel < 3 * cloud.width;
    const std::uint32_t col = pixel % cloud.width;
    for (std::uint32_t down = pixel + cloud.width; down < height.size() && down <= pixel + 3 * cloud.width;
         down += cloud.width)
    {
      if (std::isnan(height[down])) continue;
      if (component_of_[down] != kNone) break;
      ++c.edges;
      if (std::hypot(cloud.points[down].x, cloud.points[down].y) > std::hypot(p.x, p.y) + 0.15F) ++c.undercut;
      if (height[pixel] < 0.25F) ++c.feet;
      break;
    }
    if (col > 1 && component_of_[pixel - 1] == component_of_[pixel] && component_of_[pixel - 2] == component_of_[pixel])
    {
      const auto r = [&](std::uint32_t i) { return cloud.points[i].getVector3fMap().norm(); };
      ++c.triples;
      if (std::abs(r(pixel) - 2.0F * r(pixel - 1) + r(pixel - 2)) > 0.08F) ++c.rough;
    }
    c.bottom = std::min(c.bottom, height[pixel]), c.top = std::max(c.top, height[pixel]);
    c.x += p.x, c.y += p.y;
    c.footprint.add(p.x, p.y);
  }
}
}  // namespace lidar_panoptic_clustering
