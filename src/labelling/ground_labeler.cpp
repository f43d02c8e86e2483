#include "lidar_panoptic_clustering/labelling/ground_labeler.h"

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/parameters.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
// [m] a step in a surface, above the noise of two ranges (three sigma of 3 cm each)
constexpr float kStep = 0.13F;

/// What a pixel shows: places in the table of raw ids.
constexpr unsigned char kIgnored = 0, kGround = 1, kStructure = 2, kObject = 3;

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
  ids_[kIgnored] = id("ignored"), ids_[kGround] = id("ground");
  ids_[kStructure] = id("structure"), ids_[kObject] = id("object");
}

void GroundLabeler::label(LabelledCloud& cloud)
{
  if (cloud.points.size() != std::size_t{cloud.width} * cloud.height)
    throw std::invalid_argument("expected width x height points, found a cloud of " + std::to_string(cloud.width) +
                                " x " + std::to_string(cloud.height) + " with " + std::to_string(cloud.points.size()));
  const auto max_range = static_cast<float>(config_.max_range_m);
  found_ground_ = surface_.find(cloud, max_range, static_cast<float>(config_.max_slope));
  returns_.resize(cloud.points.size());
  const float above = found_ground_ ? static_cast<float>(config_.ground_height_m)  //
                                    : -std::numeric_limits<float>::infinity();
  const bool closed = closesOnItself(config_.field_of_view, measureColumnAngle(cloud, max_range), cloud.width);
  components_.start(cloud.height, cloud.width, {above, kStep, static_cast<float>(config_.link_m)}, closed);
  shown_.resize(cloud.points.size());
  for (std::uint32_t row = 0; row < cloud.height; ++row)
  {
    const std::size_t begin = std::size_t{row} * cloud.width, end = begin + cloud.width;
    surface_.locate(cloud, begin, end, returns_);
    components_.addRow(row, cloud, returns_);
    showGround(cloud, begin, end);
  }
  components_.finish(cloud, returns_, &ComponentJudge::mayHoldPerson);
  judge(cloud);
  for (const std::uint32_t pixel : components_.pixels()) showPart(cloud, pixel);
  for (const std::uint32_t pixel : components_.feet()) showPart(cloud, pixel);
}

/// What all returns are as long as nothing stands there.
void GroundLabeler::showGround(LabelledCloud& cloud, std::size_t begin, std::size_t end)
{
  // at hand: bytes that are written may be anything's
  const std::uint32_t ignored = ids_[kIgnored], ground = ids_[kGround];
  const GroundedReturn* const returns = returns_.data();
  LabelledPoint* const points = cloud.points.data();
  unsigned char* const shown = shown_.data();
  for (std::size_t i = begin; i < end; ++i)
  {
    const bool is_return = returns[i].isReturn();
    shown[i] = is_return ? kGround : kIgnored;
    points[i].label = is_return ? ground : ignored;
  }
}

void GroundLabeler::showPart(LabelledCloud& cloud, std::uint32_t pixel)
{
  const unsigned char shown = shown_of_part_[components_.partOf(pixel)];
  shown_[pixel] = shown;
  cloud.points[pixel].label = ids_[shown];
}

/// A component's parts are what it is, but for people.
void GroundLabeler::judge(const LabelledCloud& cloud)
{
  shown_of_component_.clear();
  for (std::uint32_t i = 0; i < components_.componentCount(); ++i)
    shown_of_component_.push_back(judge_.isStructure(components_.component(i)) ? kStructure : kObject);
  shown_of_part_.assign(components_.partCount(), kIgnored);
  showPeople();
  const std::vector<std::uint32_t>&component_of = components_.componentOfPart(), &apart = components_.partsApart();
  std::size_t next = apart.size();
  components_.cutColumns(cloud, returns_, leant_on_);
  shown_of_part_.resize(components_.partCount(), kIgnored);
  for (; next < apart.size(); ++next)
    if (judge_.isPersonCutOff(components_.part(apart[next]))) showPerson(apart[next]);
  for (std::uint32_t part = 0; part < shown_of_part_.size(); ++part)
    if (shown_of_part_[part] == kIgnored) shown_of_part_[part] = shown_of_component_[component_of[part]];
}

/// Those who are a part; notes the parts that others may lean on.
void GroundLabeler::showPeople()
{
  leant_on_.clear();
  for (const std::uint32_t part : components_.partsApart())
    if (judge_.isPerson(components_.part(part)))
      showPerson(part);
    else if (mayBeStall(components_.componentOfPart()[part]))
      leant_on_.push_back(part);
}

/// Sheet metal is no stall, whatever stands out of it.
bool GroundLabeler::mayBeStall(std::uint32_t component) const
{
  return shown_of_component_[component] == kStructure || !judge_.isSmooth(components_.component(component));
}

/// What is around a person and no vehicle is structure.
void GroundLabeler::showPerson(std::uint32_t part)
{
  shown_of_part_[part] = kObject;
  const std::uint32_t component = components_.componentOfPart()[part];
  const ScanComponent& around = components_.component(component);
  const bool is_most = 3 * components_.part(part).point_count > 2 * around.point_count;
  if (!is_most && !judge_.isVehicle(around)) shown_of_component_[component] = kStructure;
}

void GroundLabeler::labelUnordered(const std::vector<ScanPoint>& points, std::vector<std::uint32_t>& labels)
{
  OrganizedScan& view = view_.of(points);
  label(view.image.cloud);
  labelPoints(view, labels);
}

float GroundLabeler::heightOf(float x, float y, float z) const
{
  return found_ground_ ? surface_.heightOf(x, y, z) : std::numeric_limits<float>::quiet_NaN();
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
    labels[i] = ids_[is_shown ? shown_[pixel] : hidden(scan.points[i], scan.image.cloud, pixel)];
  }
}

unsigned char GroundLabeler::hidden(const ScanPoint& p, const LabelledCloud& cloud, std::uint32_t pixel) const
{
  constexpr float kNear = 0.35F;  // [m] a person's link
  constexpr int kRows = 2, kColumns = 4;
  if (!hasDirection(p)) return kIgnored;
  if (found_ground_ && surface_.heightOf(p.x, p.y, p.z) < static_cast<float>(config_.ground_height_m)) return kGround;
  const int rows = static_cast<int>(cloud.height), columns = static_cast<int>(cloud.width);
  const int row = static_cast<int>(pixel) / columns, column = static_cast<int>(pixel) % columns;
  const int reach = std::min(kColumns, (columns - 1) / 2);
  const int first = std::max(0, row - kRows), last = std::min(rows - 1, row + kRows);
  const bool wraps = column < reach || column + reach >= columns;
  // most have nothing but structure around them: one look at bytes that lie side by side
  bool may_be_object = wraps;
  for (int r = first; r <= last && !may_be_object; ++r)
    may_be_object = std::memchr(&shown_[static_cast<std::size_t>(r * columns + column - reach)], kObject,
                                static_cast<std::size_t>(2 * reach + 1)) != nullptr;
  if (!may_be_object) return kStructure;
  unsigned char nearest = kStructure;
  float least = kNear * kNear;
  for (int r = first; r <= last; ++r)
    for (int c = column - reach; c <= column + reach; ++c)
    {
      const auto at = static_cast<std::size_t>(r * columns + (c + columns) % columns);
      if (shown_[at] < kStructure) continue;
      const LabelledPoint& q = cloud.points[at];
      const float dx = q.x - p.x, dy = q.y - p.y, dz = q.z - p.z, squared = dx * dx + dy * dy + dz * dz;
      if (squared < least) least = squared, nearest = shown_[at];
    }
  return nearest;
}
}  // namespace lidar_panoptic_clustering
