#include "lidar_panoptic_clustering/scan_to_objects/scan_labeller.h"

#include <algorithm>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kLargestId = 0xFFFF;

std::string labelTableName(const ScanLabellerConfig& config)
{
  if (config.labels != "none") return config.label_table.empty() ? "semantic_kitti" : config.label_table;
  if (!config.label_table.empty() && config.label_table != "object")
    throw std::invalid_argument("label_table: expected 'object' or nothing, as labels is 'none', found '" +
                                config.label_table + "'");
  return "object";
}
}  // namespace

ScanLabeller::ScanLabeller(const ScanLabellerConfig& config)
    : label_table_(std::make_shared<const ClassTable>(ClassTable::load(labelTableName(config)))),
      numbering_(label_table_, {!config.label_table.empty(), config.max_unknown_labels, config.check_label_shapes}),
      no_class_(ignoredId(*label_table_)),
      height_as_intensity_(config.height_as_intensity),
      ground_(config.ground)
{
  const std::string target = config.class_table.empty() ? labelTableName(config) : config.class_table;
  class_table_ = std::make_shared<const ClassTable>(ClassTable::load(target));
  if (config.height_as_intensity && config.labels != "none")
    throw std::invalid_argument("height_as_intensity: expected labels to be 'none', found '" + config.labels + "'");
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
  takeClasses(scan);
  findHiddenLabels(scan);
  numbering_.check(scan.image.cloud, hidden_labels_);
  mapIds(scan);
}

void ScanLabeller::takeImage(const RawImage& image, OrganizedScan& scan)
{
  readLabelImage(image, scan.image.cloud.height, scan.image.cloud.width, separate_);
  labelPixels(scan, separate_, no_class_);
  takeClasses(scan);
  numbering_.check(scan.image.cloud);
  mapIds(scan);
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
  {
    ground_.labelUnordered(scan.points, separate_);
    labelPoints(scan, separate_);
  }
  else
  {
    ground_.label(scan.image.cloud);
    if (all) ground_.labelPoints(scan, scan.labels);
  }
  if (height_as_intensity_) writeHeights(scan.image.cloud);
  mapIds(scan);
}

void ScanLabeller::writeHeights(LabelledCloud& cloud) const
{
  for (LabelledPoint& point : cloud.points)
    if (hasDirection({point.x, point.y, point.z, 0.0F})) point.intensity = ground_.heightOf(point.x, point.y, point.z);
}

/// Labels of a .label file lose their instances, and what is no return can be no thing.
void ScanLabeller::takeClasses(OrganizedScan& scan)
{
  std::uint32_t largest = 0;
  for (const LabelledPoint& pixel : scan.image.cloud.points) largest = std::max(largest, pixel.label);
  for (const std::uint32_t label : scan.labels) largest = std::max(largest, label);
  if (largest > kLargestId)
  {
    for (LabelledPoint& pixel : scan.image.cloud.points) pixel.label = classIn(pixel.label);
    for (std::uint32_t& label : scan.labels) label = classIn(label);
  }
  if (scan.organized_input || label_table_->kindOf(0) != ClassKind::kThing) return;
  for (std::size_t i = 0; i < scan.points.size(); ++i)
    if (!hasDirection(scan.points[i])) scan.labels[i] = no_class_;
}

std::uint32_t ScanLabeller::classIn(std::uint32_t label) const
{
  if (label == kUnreadableLabel) return label_table_->ignoresMinusOne() ? no_class_ : label;
  return label & kLargestId;
}

void ScanLabeller::findHiddenLabels(const OrganizedScan& scan)
{
  hidden_labels_.clear();
  if (scan.organized_input) return;
  const Projection& image = scan.image;
  for (std::uint32_t i = 0; i < scan.points.size(); ++i)
    if (image.owner_of_pixel[image.pixel_of_point[i]] != i && hasDirection(scan.points[i]))
      hidden_labels_.push_back(scan.labels[i]);
}

void ScanLabeller::mapIds(OrganizedScan& scan) const
{
  if (!mapping_) return;
  for (LabelledPoint& point : scan.image.cloud.points) point.label = (*mapping_)(point.label);
  for (std::uint32_t& label : scan.labels) label = (*mapping_)(label);
}
}  // namespace lidar_panoptic_clustering
