#include "lidar_panoptic_clustering/labelling/ground_labeler.h"

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/parameters.h"

#include <limits>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPersonHeight = 2.2F;  // [m] with a hat on; cars are lower, vans, trucks and buses higher
constexpr float kHovering = 2.0F;      // [m] nothing that drives or walks ends above
constexpr float kWidest = 3.2F;        // [m] the European limit of 2.55 with mirrors
constexpr std::uint32_t kFewestReturns = 4, kFewestFeet = 5, kFewestTriples = 20;

/// What a component is judged by.
struct Appearance
{
  explicit Appearance(const ScanComponent& c)
      : size(c.footprint.smallestRectangle()),
        tall(c.top > kPersonHeight),
        maybe_tall(tall || c.open_top),
        has_feet(c.feet >= kFewestFeet),
        undercut(has_feet ? share(c.undercut_feet, c.feet) : 0.0F),
        rough(c.triples >= kFewestTriples ? share(c.rough_triples, c.triples) : 0.0F)
  {
  }

  static float share(std::uint32_t part, std::uint32_t whole)
  {
    return static_cast<float>(part) / static_cast<float>(whole);
  }

  RectangleSize size;
  bool tall, maybe_tall;
  bool has_feet;
  float undercut, rough;  // shares
};

bool isPole(const ScanComponent& c, const Appearance& a)
{
  if (a.maybe_tall && a.size.length < 1.0F && (a.tall || c.bottom > 0.5F)) return true;
  // thinner than a person, from the side too; posts of signs are 0.06 to 0.1 m thick
  return c.top > 1.5F && (a.size.length < 0.18F || (a.size.length < 0.6F && a.size.width < 0.1F));
}

/// Riders and their two-wheelers are as rough, but small, and stand on wheels.
bool isFoliage(const Appearance& a)
{
  const bool may_be_rider = a.undercut >= 0.5F && a.size.length < 2.2F && !a.tall;
  return a.rough > 0.45F && !may_be_rider;
}

bool isWall(const ScanComponent& c, const Appearance& a)
{
  // the ground goes on under vehicles; what has a car's footprint gets the benefit of the doubt, for a wheel or a sill
  // near the ground hides it
  const bool has_cars_footprint = a.size.width > 1.3F && a.size.length < 7.0F;
  if (a.maybe_tall && a.has_feet && a.undercut < (has_cars_footprint ? 0.2F : 0.5F)) return true;
  if (!has_cars_footprint && a.size.length > 1.5F && a.has_feet && a.undercut < 0.35F) return true;
  // seen over something that hides its foot
  if (a.maybe_tall && !a.has_feet && c.bottom > 0.25F && a.size.width < 1.3F) return true;
  // fences and hedges: no vehicle is so long, as low as a car, and shows no width
  return !a.maybe_tall && a.size.length > 6.0F && a.size.width < 0.3F;
}
}  // namespace

GroundLabeler::GroundLabeler(const GroundLabelerConfig& config) : config_(config)
{
  validateParameters(config_);
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
  components_.find(cloud, returns_, above, static_cast<float>(config_.link_m), closed);

  label_of_component_.clear();
  for (const ScanComponent& c : components_.list())
    label_of_component_.push_back(isStructure(c) ? structure_ : object_);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    const std::uint32_t component = components_.of(i);
    cloud.points[i].label = component != ScanComponents::kNone ? label_of_component_[component]
                            : returns_[i].isReturn()           ? ground_
                                                               : ignored_;
  }
}

bool GroundLabeler::isStructure(const ScanComponent& c) const
{
  if (c.point_count < kFewestReturns) return true;
  if (c.top > static_cast<float>(config_.max_height_m) || c.bottom > kHovering) return true;
  if (!c.footprint.fits(static_cast<float>(config_.max_length_m), kWidest)) return true;
  const Appearance appearance(c);
  return isPole(c, appearance) || isFoliage(appearance) || isWall(c, appearance);
}
}  // namespace lidar_panoptic_clustering
