#include "lidar_panoptic_clustering/scan_to_objects/scan_labeller.h"

#include <cmath>
#include <map>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
std::string labelTableName(const ScanLabellerConfig& config)
{
  if (config.labels != "none") return config.label_table.empty() ? "semantic_kitti" : config.label_table;
  if (!config.label_table.empty() && config.label_table != "object")
    throw std::invalid_argument("label_table: expected 'object' or nothing, as labels is 'none', found '" +
                                config.label_table + "'");
  return "object";
}

/// "24 (30512 points), 28 (9033 points)", the most frequent ones.
std::string describeUnknown(const std::map<std::uint32_t, std::size_t>& count_of_id)
{
  std::multimap<std::size_t, std::uint32_t, std::greater<>> by_count;
  for (const auto& [id, count] : count_of_id) by_count.emplace(count, id);
  constexpr std::size_t kNamed = 5;
  std::string text;
  std::size_t named = 0;
  for (const auto& [count, id] : by_count)
  {
    if (named++ == kNamed) break;
    text += (text.empty() ? "" : ", ") + std::to_string(id) + " (" + std::to_string(count) + " points)";
  }
  return text;
}
}  // namespace

ScanLabeller::ScanLabeller(const ScanLabellerConfig& config)
    : max_unknown_(config.max_unknown_labels),
      label_table_(std::make_unique<const ClassTable>(ClassTable::load(labelTableName(config)))),
      ground_(config.ground)
{
  const std::string target = config.class_table.empty() ? labelTableName(config) : config.class_table;
  class_table_ = std::make_shared<const ClassTable>(ClassTable::load(target));
  if (target == labelTableName(config)) return;
  mapping_.emplace(*label_table_, *class_table_);
  if (config.labels == "none") requireObjects();
}

/// Else whatever the ground labeler finds would be lost without a word.
void ScanLabeller::requireObjects() const
{
  const std::uint32_t object = (*label_table_)[label_table_->findByName("object")].ids.at(0);
  if (!(*class_table_)[class_table_->find((*mapping_)(object))].isThing())
    throw std::invalid_argument("class_table: expected one with a thing class 'object', as labels is 'none', found '" +
                                class_table_->name() + "'");
}

void ScanLabeller::takeOwn(OrganizedScan& scan)
{
  checkTable(scan);
  mapIds(scan);
}

void ScanLabeller::takeImage(const RawImage& image, OrganizedScan& scan)
{
  readLabelImage(image, scan.image.cloud.height, scan.image.cloud.width, separate_);
  labelPixels(scan, separate_);
  takeOwn(scan);
}

void ScanLabeller::takeCloud(const RawCloud& labels, const std::string& label_field, const RawCloud& cloud,
                             OrganizedScan& scan)
{
  readLabelCloud(labels, label_field, cloud, separate_);
  labelPoints(scan, separate_);
  takeOwn(scan);
}

void ScanLabeller::takeGeometry(OrganizedScan& scan, bool all)
{
  if (scan.layout == Layout::kMerged)
    throw std::invalid_argument("expected scan lines, as labels is 'none', found the points of several lidars merged");
  ground_.label(scan.image.cloud);
  if (all) ground_.labelPoints(scan, scan.labels);
  mapIds(scan);
}

void ScanLabeller::checkTable(const OrganizedScan& scan) const
{
  std::size_t labelled = 0, unknown = 0;
  for (const LabelledPoint& point : scan.image.cloud.points)
  {
    if (!std::isfinite(point.x) || point.label == 0) continue;  // 0: whatever the table, no class is often sent so
    ++labelled;
    if (label_table_->find(point.label) == kUnknownClass) ++unknown;
  }
  if (static_cast<double>(unknown) <= max_unknown_ * static_cast<double>(labelled)) return;

  std::map<std::uint32_t, std::size_t> count_of_id;
  for (const LabelledPoint& point : scan.image.cloud.points)
    if (std::isfinite(point.x) && point.label != 0 && label_table_->find(point.label) == kUnknownClass)
      ++count_of_id[point.label];
  throw std::invalid_argument("expected class ids of the table '" + label_table_->name() +
                              "' (parameter label_table), found that " + std::to_string(unknown) + " of " +
                              std::to_string(labelled) +
                              " labelled returns have others: " + describeUnknown(count_of_id));
}

void ScanLabeller::mapIds(OrganizedScan& scan) const
{
  if (!mapping_) return;
  for (LabelledPoint& point : scan.image.cloud.points) point.label = (*mapping_)(point.label);
  for (std::uint32_t& label : scan.labels) label = (*mapping_)(label);
}
}  // namespace lidar_panoptic_clustering
