#include "lidar_panoptic_clustering/datasets/predicted_classes.h"

#include "lidar_panoptic_clustering/core/label_numbering.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::size_t kLooks = 8;
constexpr std::uint32_t kMinusOne = 0xFFFFFFFFU;

bool isKnown(std::uint32_t label, const ClassTable& table)
{
  return table.find(rawClass(label)) != kUnknownClass || (label == kMinusOne && table.ignoresMinusOne());
}

bool namesAll(const std::vector<std::uint32_t>& labels, const ClassTable& table)
{
  return std::all_of(labels.begin(), labels.end(), [&table](std::uint32_t label) { return isKnown(label, table); });
}
}  // namespace

PredictedClasses::PredictedClasses(const SemanticKittiSequence& sequence, std::shared_ptr<const ClassTable> class_table,
                                   const std::string& label_table)
    : label_table_(label_table.empty() ? class_table
                                       : std::make_shared<const ClassTable>(ClassTable::load(label_table))),
      no_class_(rawClass(ignoredId(*label_table_)))
{
  if (label_table_->name() != class_table->name()) mapping_.emplace(*label_table_, *class_table);
  look(sequence, !label_table.empty());
}

void PredictedClasses::look(const SemanticKittiSequence& sequence, bool chosen)
{
  LabelNumbering numbering(label_table_, {chosen, 0.0, true});
  PointProjector projector{ProjectionConfig()};
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> labels;
  Projection image;
  const std::size_t looks = std::min(kLooks, sequence.size());
  for (std::size_t i = 0; i < looks; ++i)
  {
    const std::size_t scan = looks == 1 ? 0 : i * (sequence.size() - 1) / (looks - 1);
    try
    {
      sequence.readScan(scan, points);
      sequence.readPredictions(scan, points.size(), labels);
    }
    catch (const std::runtime_error&)
    {
      continue;
    }
    for (std::uint32_t& label : labels) label = classOf(label);
    projector.project(points, labels, image);
    try
    {
      numbering.check(image.cloud, labels);
    }
    catch (const std::invalid_argument& error)
    {
      throw std::runtime_error(sequence.predictionFile(scan) + ": " + error.what());
    }
  }
  doubt_ = numbering.doubt();
}

std::uint32_t PredictedClasses::classOf(std::uint32_t label) const
{
  return label == kMinusOne && label_table_->ignoresMinusOne() ? no_class_ : rawClass(label);
}

void PredictedClasses::read(const SemanticKittiSequence& sequence, std::size_t scan, std::size_t point_count,
                            std::vector<std::uint32_t>& labels) const
{
  sequence.readPredictions(scan, point_count, labels);
  requireKnownClasses(labels, *label_table_, sequence.predictionFile(scan));
  if (!mapping_ && !label_table_->ignoresMinusOne()) return;
  for (std::uint32_t& label : labels)
  {
    const std::uint32_t id = classOf(label), instance = label == kMinusOne ? 0 : rawInstance(label);
    label = instance << 16U | rawClass(mapping_ ? (*mapping_)(id) : id);
  }
}

void requireKnownClasses(const std::vector<std::uint32_t>& labels, const ClassTable& table, const std::string& file)
{
  const auto found =
      std::find_if_not(labels.begin(), labels.end(), [&table](std::uint32_t label) { return isKnown(label, table); });
  if (found == labels.end()) return;
  std::string fitting;
  for (const std::string& name : ClassTable::shippedNames())
    if (name != "object" && namesAll(labels, ClassTable::load(name)))
      fitting += (fitting.empty() ? "'" : ", '") + name + "'";
  throw std::runtime_error(file + ": point " + std::to_string(found - labels.begin()) + " has class id " +
                           idText(*found == kMinusOne ? *found : rawClass(*found)) + ", which is not in class table '" +
                           table.name() + "'" +
                           (fitting.empty() ? "" : "; all ids of the file are in the tables " + fitting));
}
}  // namespace lidar_panoptic_clustering
