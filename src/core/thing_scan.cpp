#include "lidar_panoptic_clustering/core/thing_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMaxUnknownLabels = 16;

bool isReturn(const LabelledPoint& p, float max_squared_range)
{
  const float squared_range = p.x * p.x + p.y * p.y + p.z * p.z;
  return squared_range > 0.0F && squared_range <= max_squared_range;  // false for NaN and infinity
}

/// Link key by class index, 0..count-1 over the thing classes: what the policy calls the same.
std::array<std::uint8_t, 256> linkKeys(const ClassTable& table, ClassPolicy policy, std::uint32_t& count)
{
  std::array<std::uint8_t, 256> keys{};
  std::array<int, 256> key_of_group;
  key_of_group.fill(-1);
  count = 0;
  for (std::size_t c = 0; c < table.size(); ++c)
  {
    const ClassInfo& info = table[static_cast<ClassIndex>(c)];
    if (!info.isThing()) continue;
    int& shared = key_of_group[policy == ClassPolicy::kGroup ? info.group : 0];
    if (shared < 0 || policy == ClassPolicy::kClass) shared = static_cast<int>(count++);
    keys[c] = static_cast<std::uint8_t>(shared);
  }
  return keys;
}

/// Median over the scan lines of the azimuth a line spans, divided by its columns [rad]; for sectors.
float measureColumnAngle(const LabelledCloud& cloud, float max_squared_range)
{
  std::vector<float> angles;
  for (std::uint32_t row = 0; row < cloud.height; ++row)
  {
    const LabelledPoint* line = cloud.points.data() + static_cast<std::size_t>(row) * cloud.width;
    std::uint32_t first = 0, last = cloud.width;
    while (first < cloud.width && !isReturn(line[first], max_squared_range)) ++first;
    while (last > first && !isReturn(line[last - 1], max_squared_range)) --last;
    if (last < first + 2) continue;
    const LabelledPoint &a = line[first], &b = line[last - 1];
    const float turned = std::abs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
    angles.push_back(turned / static_cast<float>(last - 1 - first));
  }
  if (angles.empty()) return 0.0F;
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::nth_element(angles.begin(), middle, angles.end());
  return *middle;
}

void noteUnknown(std::vector<std::uint32_t>& labels, std::uint32_t label)
{
  if (labels.size() < kMaxUnknownLabels && std::find(labels.begin(), labels.end(), label) == labels.end())
    labels.push_back(label);
}
}  // namespace

const std::vector<std::string>& classPolicyNames()
{
  static const std::vector<std::string> names = {"class", "group", "any"};
  return names;
}

ClassPolicy classPolicyFromName(const std::string& name)
{
  const auto& names = classPolicyNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument("class_policy is '" + name + "', expected class, group or any");
  return static_cast<ClassPolicy>(found - names.begin());
}

void selectThings(const LabelledCloud& cloud, const ClassTable& table, const SelectionConfig& config, ThingScan& scan)
{
  const std::size_t pixels = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (cloud.points.size() != pixels)
    throw std::invalid_argument("cloud is " + std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                                " (width x height) but holds " + std::to_string(cloud.points.size()) + " points");

  const auto max_squared_range = static_cast<float>(config.max_range_m * config.max_range_m);
  const auto keys = linkKeys(table, classPolicyFromName(config.class_policy), scan.link_count);
  scan.class_link_distance.resize(table.size());
  for (std::size_t c = 0; c < table.size(); ++c)
    scan.class_link_distance[c] =
        static_cast<float>(config.link_distance_scale) * table[static_cast<ClassIndex>(c)].link_distance_m;
  scan.class_count = static_cast<std::uint32_t>(table.size());
  scan.rows = cloud.height, scan.columns = cloud.width, scan.full_turn = config.full_turn;
  scan.points.clear(), scan.link.clear(), scan.class_index.clear(), scan.unknown_labels.clear();
  scan.line_begin.resize(scan.rows + 1);
  scan.column_angle = config.full_turn ? static_cast<float>(2.0 * kPi / std::max(1U, scan.columns))
                                       : measureColumnAngle(cloud, max_squared_range);

  const LabelledPoint* point = cloud.points.data();
  for (std::uint32_t row = 0; row < scan.rows; ++row)
  {
    scan.line_begin[row] = static_cast<std::uint32_t>(scan.points.size());
    for (std::uint32_t column = 0; column < scan.columns; ++column, ++point)
    {
      const ClassIndex class_index = table.find(point->label);
      if (!table[class_index].isThing())
      {
        if (class_index == kUnknownClass) noteUnknown(scan.unknown_labels, point->label);
        continue;
      }
      if (!isReturn(*point, max_squared_range)) continue;
      scan.points.push_back({point->x, point->y, point->z, column});
      scan.link.push_back(keys[class_index]);
      scan.class_index.push_back(class_index);
    }
  }
  scan.line_begin[scan.rows] = static_cast<std::uint32_t>(scan.points.size());
}
}  // namespace lidar_panoptic_clustering
