#include "python/class_labels.h"

#include "lidar_panoptic_clustering/datasets/predicted_classes.h"

#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
ClassLabels::ClassLabels(const ClassLabelsConfig& config)
    : table_(std::make_shared<const ClassTable>(ClassTable::load(config.class_table))),
      label_table_(config.label_table.empty()
                       ? table_
                       : std::make_shared<const ClassTable>(ClassTable::load(config.label_table))),
      max_unknown_(config.max_unknown_labels),
      no_class_(rawClass(ignoredId(*label_table_)))
{
  if (label_table_->name() != table_->name()) mapping_.emplace(*label_table_, *table_);
}

void ClassLabels::read(const IdsView& view, std::vector<std::uint32_t>& classes) const
{
  constexpr std::uint32_t kMinusOne = std::numeric_limits<std::uint32_t>::max();
  readIds(view, "labels", classes);
  const bool minus_one = label_table_->ignoresMinusOne();
  std::size_t unknown = 0;
  for (const std::uint32_t label : classes)
    if (label_table_->find(rawClass(label)) == kUnknownClass && !(minus_one && label == kMinusOne)) ++unknown;
  if (static_cast<double>(unknown) > max_unknown_ * static_cast<double>(classes.size()))
  {
    try
    {
      requireKnownClasses(classes, *label_table_, "labels");
    }
    catch (const std::runtime_error& error)
    {
      throw std::invalid_argument(error.what());
    }
  }
  for (std::uint32_t& label : classes)
  {
    const std::uint32_t id = minus_one && label == kMinusOne ? no_class_ : rawClass(label);
    label = mapping_ ? rawClass((*mapping_)(id)) : id;
  }
}
}  // namespace lidar_panoptic_clustering
