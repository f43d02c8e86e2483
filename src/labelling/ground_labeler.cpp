#include "lidar_panoptic_clustering/labelling/ground_labeler.h"

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
// [m] a step in a surface, above the noise of two ranges (three sigma of 3 cm each)
constexpr float kStep = 0.13F;

const GroundLabelerConfig& validated(const GroundLabelerConfig& config)
{
  validateParameters(config);
  return config;
}
}  // namespace

GroundLabeler::GroundLabeler(const GroundLabelerConfig& config)
    : config_(validated(config)),
      judge_({static_cast<float>(config.max_height_m), static_cast<float>(config.max_length_m)},
             structureBiasFromName(config.structure))
{
  const ClassTable table = ClassTable::load("object");
  const auto id = [&table](const char* name) { return table[table.findByName(name)].ids.at(0); };
  ignored_ = id("ignored"), ground_ = id("ground"), structure_ = id("structure"), object_ = id("object");
}

void GroundLabeler::label(LabelledCloud& cloud)
{
  if (cloud.points.size() != std::size_t{cloud.width} * cloud.height)
    throw std::invalid_argument("expected width x height points, found a cloud of " + std::to_string(cloud.width) +
                                " x " + std::to_string(cloud.height) + " with " + std::to_string(cloud.points.size()));
  const auto max_range = static_cast<float>(config_.max_range_m);
  found_ground_ = surface_.measure(cloud, max_range, static_cast<float>(config_.max_slope), returns_);
  const float above = found_ground_ ? static_cast<float>(config_.ground_height_m)  //
                                    : -std::numeric_limits<float>::infinity();
  const bool closed = closesOnItself(config_.field_of_view, measureColumnAngle(cloud, max_range), cloud.width);
  components_.find(cloud, returns_, {above, kStep, static_cast<float>(config_.link_m)}, closed);
  judge();
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    const std::uint32_t part = components_.partOf(i);
    cloud.points[i].label = part != ScanComponents::kNone ? label_of_part_[part]
                            : returns_[i].isReturn()      ? ground_
                                                          : ignored_;
  }
}

/// A component's parts are what it is, but for people.
void GroundLabeler::judge()
{
  const auto& parts = components_.parts();
  const auto& components = components_.list();
  label_of_component_.clear();
  for (const ScanComponent& c : components) label_of_component_.push_back(judge_.isStructure(c) ? structure_ : object_);
  label_of_part_.assign(parts.size(), ignored_);
  for (std::uint32_t part = 0; part < parts.size(); ++part)
  {
    const std::uint32_t component = components_.componentOfPart()[part];
    if (!judge_.isPerson(parts[part])) continue;
    label_of_part_[part] = object_;
    const bool is_most = 3 * parts[part].point_count > 2 * components[component].point_count;
    if (!is_most && !judge_.isVehicle(components[component])) label_of_component_[component] = structure_;
  }
  for (std::uint32_t part = 0; part < parts.size(); ++part)
    if (label_of_part_[part] == ignored_)
      label_of_part_[part] = label_of_component_[components_.componentOfPart()[part]];
}

void GroundLabeler::labelUnordered(const std::vector<ScanPoint>& points, std::vector<std::uint32_t>& labels)
{
  OrganizedScan& view = view_.of(points);
  label(view.image.cloud);
  labelPoints(view, labels);
}

GroundReport GroundLabeler::ground() const
{
  if (!found_ground_) return {};
  const SlopedPlane& plane = surface_.plane();
  const double slope = std::hypot(double{plane.slope_x}, double{plane.slope_y});
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  return {true, plane, -double{plane.offset} / std::hypot(1.0, slope), kDegrees * std::atan(slope)};
}

void GroundLabeler::labelPoints(const OrganizedScan& scan, std::vector<std::uint32_t>& labels) const
{
  labels.resize(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i)
  {
    const std::uint32_t pixel = scan.image.pixel_of_point[i];
    const bool is_shown = scan.organized_input || scan.image.owner_of_pixel[pixel] == i;
    labels[i] = is_shown ? scan.image.cloud.points[pixel].label : hiddenLabel(scan.points[i], scan.image.cloud, pixel);
  }
}

std::uint32_t GroundLabeler::hiddenLabel(const ScanPoint& p, const LabelledCloud& cloud, std::uint32_t pixel) const
{
  constexpr float kNear = 0.35F;  // [m] a person's link
  constexpr int kRows = 2, kColumns = 4;
  if (!hasDirection(p)) return ignored_;
  if (found_ground_ && surface_.heightOf(p.x, p.y, p.z) < static_cast<float>(config_.ground_height_m)) return ground_;
  std::uint32_t label = structure_;
  float least = kNear * kNear;
  const int rows = static_cast<int>(cloud.height), columns = static_cast<int>(cloud.width);
  const int row = static_cast<int>(pixel) / columns, column = static_cast<int>(pixel) % columns;
  const int reach = std::min(kColumns, (columns - 1) / 2);
  for (int r = std::max(0, row - kRows); r <= std::min(rows - 1, row + kRows); ++r)
    for (int c = column - reach; c <= column + reach; ++c)
    {
      const LabelledPoint& q = cloud.points[static_cast<std::size_t>(r * columns + (c + columns) % columns)];
      if (q.label != structure_ && q.label != object_) continue;
      const float dx = q.x - p.x, dy = q.y - p.y, dz = q.z - p.z, squared = dx * dx + dy * dy + dz * dz;
      if (squared < least) least = squared, label = q.label;
    }
  return label;
}
}  // namespace lidar_panoptic_clustering
