#include "lidar_panoptic_clustering/labelling/ground_labeler.h"

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/parameters.h"

namespace lidar_panoptic_clustering
{
GroundLabeler::GroundLabeler(const GroundLabelerConfig& config) : config_(config)
{
  validateParameters(config_);
  const ClassTable table = ClassTable::load("object");
  const auto id = [&table](const char* name) { return table[table.findByName(name)].ids.at(0); };
  ignored_ = id("ignored"), ground_ = id("ground"), structure_ = id("structure"), object_ = id("object");
}

bool GroundLabeler::isStructure(const ScanComponent& c) const
{
  if (c.top > static_cast<float>(config_.max_height_m)) return true;
  if (c.bottom > static_cast<float>(config_.floating_m)) return true;
  if (!c.footprint.fits(static_cast<float>(config_.max_length_m), 3.2F)) return true;
  const RectangleSize size = c.footprint.smallestRectangle();
  const bool tall = c.top > 2.2F;
  const bool maybe_tall = tall || c.open_top;
  const bool footed = c.edges >= 5;
  const float undercut = footed ? static_cast<float>(c.undercut) / static_cast<float>(c.edges) : 0.0F;
  if (c.point_count < 8) return true;
  if (maybe_tall && size.length < 1.0F && (tall || c.bottom > 0.5F)) return true;
  const bool rider = undercut >= 0.5F && size.length < 2.2F && !tall;
  if (c.triples >= 10 && !rider && static_cast<float>(c.rough) > 0.45F * static_cast<float>(c.triples)) return true;
  if (maybe_tall && !footed && c.bottom > 0.4F && size.width < 1.0F) return true;
  if (maybe_tall && footed && undercut < 0.5F) return true;
  if (footed && undercut < 0.35F && size.length > 1.5F) return true;
  if (size.length > 4.0F && size.width < 0.3F) return true;
  return false;
}

void GroundLabeler::label(LabelledCloud& cloud)
{
  const auto above = static_cast<float>(config_.ground_height_m);
  surface_.measure(cloud, static_cast<float>(config_.max_range_m), static_cast<float>(config_.max_slope), height_);
  components_.find(cloud, height_, above, static_cast<float>(config_.link_m), config_.full_turn);
  label_of_component_.clear();
  for (const ScanComponent& c : components_.list())
    label_of_component_.push_back(isStructure(c) ? structure_ : object_);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    const std::uint32_t component = components_.of(i);
    cloud.points[i].label = component != ScanComponents::kNone ? label_of_component_[component]
                            : height_[i] < above               ? ground_
                                                               : ignored_;
  }
}
}  // namespace lidar_panoptic_clustering
