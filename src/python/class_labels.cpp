#include "python/class_labels.h"

#include "lidar_panoptic_clustering/datasets/predicted_classes.h"

#include <limits>
#include <optional>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kMinusOne = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kLabels = 1U << 16U;  ///< classes that a label can have
constexpr std::uint32_t kUnknownBit = 31, kUnknown = 1U << kUnknownBit;
}  // namespace

ClassLabels::ClassLabels(const ClassLabelsConfig& config)
    : table_(std::make_shared<const ClassTable>(ClassTable::load(config.class_table))),
      label_table_(config.label_table.empty()
                       ? table_
                       : std::make_shared<const ClassTable>(ClassTable::load(config.label_table))),
      max_unknown_(config.max_unknown_labels),
      no_class_(rawClass(ignoredId(*label_table_)))
{
  std::optional<ClassMapping> mapping;
  if (label_table_->name() != table_->name()) mapping.emplace(*label_table_, *table_);
  class_of_label_.resize(kLabels);
  for (std::uint32_t id = 0; id < kLabels; ++id)
    class_of_label_[id] =
        (mapping ? rawClass((*mapping)(id)) : id) | (label_table_->find(id) == kUnknownClass ? kUnknown : 0U);
}

void ClassLabels::read(const IdsView& view, std::vector<std::uint32_t>& classes) const
{
  readIds(view, "labels", classes);
  const std::uint32_t no_class = class_of_label_[no_class_], minus_one = minusOneStandsFor(no_class);
  std::size_t unknown = 0;
  for (std::uint32_t& label : classes)
  {
    const std::uint32_t found = label == kMinusOne ? minus_one : class_of_label_[rawClass(label)];
    unknown += found >> kUnknownBit;
    label = rawClass(found);
  }
  if (static_cast<double>(unknown) > max_unknown_ * static_cast<double>(classes.size())) refuse(view);
}

/// -1 is what no table has, but where it stands for no class.
std::uint32_t ClassLabels::minusOneStandsFor(std::uint32_t no_class) const
{
  return label_table_->ignoresMinusOne() ? no_class & ~kUnknown : class_of_label_[rawClass(kMinusOne)];
}

void ClassLabels::refuse(const IdsView& view) const
{
  std::vector<std::uint32_t> labels;
  readIds(view, "labels", labels);
  try
  {
    requireKnownClasses(labels, *label_table_, "labels");
  }
  catch (const std::runtime_error& error)
  {
    throw std::invalid_argument(error.what());
  }
  throw std::invalid_argument("labels: expected that nobody writes to them while they are read, found others");
}
}  // namespace lidar_panoptic_clustering
