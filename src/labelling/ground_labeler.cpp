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
constexpr std::uint32_t kNone = ScanComponents::kNone;
constexpr float kPersonHeight = 2.2F;  // [m] with a hat on; cars are lower, vans, trucks and buses higher
constexpr float kHovering = 2.0F;      // [m] nothing that drives or walks ends above
constexpr float kWidest = 3.2F;        // [m] the European limit of 2.55 with mirrors
constexpr std::uint32_t kFewestReturns = 4, kFewestFeet = 5, kFewestTriples = 20;
static const float* X(){ static float x[20]; static bool init=false; if(!init){init=true; const char*e=getenv("XV"); float d[]={0.5F,0.6F,0.2F,0.5F,0.35F,1.3F,0.45F,7.0F,0.25F,0,0,0}; for(int i=0;i<12;++i)x[i]=d[i]; if(e){ std::string s(e); size_t p=0; while(p<s.size()){ int k; float v; int n; if(sscanf(s.c_str()+p,"%d=%f%n",&k,&v,&n)<2) break; x[k]=v; p+=n+1; } } } return x; }

/// What a component is judged by.
struct Appearance
{
  explicit Appearance(const ScanComponent& c)
      : size(c.footprint.smallestRectangle()),
        tall(c.top > kPersonHeight),
        maybe_tall(tall || c.open_top),
        has_feet(c.blocked + c.undercut >= kFewestFeet),
        undercut(has_feet ? share(c.undercut, c.blocked + c.undercut) : 0.0F),
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
  const bool may_be_rider = (X()[9]>0 ? (!a.has_feet || a.undercut >= 0.5F) : a.undercut>=0.5F) && a.size.length < 2.2F && !a.tall;
  return a.rough > X()[6] && !may_be_rider;
}

bool isWall(const ScanComponent& c, const Appearance& a)
{
  // the ground goes on under vehicles; what has a car's footprint gets the benefit of the doubt, for a wheel or a sill
  // near the ground hides it
  const bool has_cars_footprint = a.size.width > X()[5] && a.size.length < X()[7];
  if (a.maybe_tall && a.has_feet && a.undercut < (has_cars_footprint ? X()[2] : X()[3])) return true;
  if (!has_cars_footprint && a.size.length > 1.5F && a.has_feet && a.undercut < X()[4]) return true;
  // seen over something that hides its foot
  if (a.maybe_tall && !a.has_feet && c.bottom > X()[8] && a.size.width < (X()[10]>0?X()[10]:1.3F)) return true;
  // fences and hedges: no vehicle is so long, as low as a car, and shows no width
  return !a.maybe_tall && a.size.length > 6.0F && a.size.width < 0.3F;
}

/// What shows that it is a vehicle.
bool isVehicle(const ScanComponent& c)
{
  const Appearance a(c);
  if (a.rough > 0.32F) return false;
  return a.has_feet ? a.undercut >= 0.5F : a.size.width > 1.2F && a.size.length < 7.0F;
}

/// A person before a wall, a stall or a hedge: what hangs together by a person's own surface, is of a person's size and
/// height, and stands free on at least half of its outline. Its feet may be hidden; a trunk is rougher or reaches higher.
bool isPerson(const ScanComponent& c)
{
  if (c.open_top || c.top < 1.2F || c.top > 2.1F || c.top - c.bottom < 0.5F || c.bottom > 1.1F) return false;
  const RectangleSize size = c.footprint.smallestRectangle();
  if (size.length < 0.3F || size.length > 1.1F || size.width < 0.15F || size.width > 0.9F) return false;
  if (c.point_count < 10 || Appearance::share(c.free_ends, c.ends) < X()[0]) return false;
  return c.triples < kFewestTriples || Appearance::share(c.rough_triples, c.triples) < X()[1];
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
  components_.find(cloud, returns_, {above, 0.13F, static_cast<float>(config_.link_m)}, closed);

  label_of_part_.clear();
  label_of_component_.clear();
  for (const ScanComponent& c : components_.list())
    label_of_component_.push_back(isStructure(c) ? structure_ : object_);
  holds_person_.assign(components_.list().size(), 0);
  for (std::uint32_t part = 0; part < components_.parts().size(); ++part)
  {
    const std::uint32_t component = components_.componentOfPart()[part];
    const std::uint32_t label = label_of_component_[component];
    const bool person = isPerson(components_.parts()[part]);
    if (person && components_.list()[component].point_count > 1.5*components_.parts()[part].point_count && !isVehicle(components_.list()[component])) holds_person_[component] = 1;
    label_of_part_.push_back(person ? object_ : label == object_ ? kNone : structure_);
  }
  for (std::uint32_t part = 0; part < components_.parts().size(); ++part)
    if (label_of_part_[part] == kNone)
      label_of_part_[part] = holds_person_[components_.componentOfPart()[part]] != 0 ? structure_ : object_;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    const std::uint32_t part = components_.partOf(i);
    cloud.points[i].label = part != ScanComponents::kNone ? label_of_part_[part]
                            : returns_[i].isReturn()      ? ground_
                                                          : ignored_;
  }
}

void GroundLabeler::labelPoints(const OrganizedScan& scan, std::vector<std::uint32_t>& labels) const
{
  constexpr float kNear = 0.7F;  // [m]
  const auto above = static_cast<float>(config_.ground_height_m);
  const LabelledCloud& cloud = scan.image.cloud;
  const auto rows = static_cast<std::int64_t>(cloud.height), columns = static_cast<std::int64_t>(cloud.width);
  labels.resize(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i)
  {
    const std::uint32_t pixel = scan.image.pixel_of_point[i];
    if (scan.organized_input || scan.image.owner_of_pixel[pixel] == i)
    {
      labels[i] = cloud.points[pixel].label;
      continue;
    }
    const ScanPoint& p = scan.points[i];
    labels[i] = ignored_;
    if (!hasDirection(p)) continue;
    if (found_ground_ && surface_.heightOf(p.x, p.y, p.z) < above)
    {
      labels[i] = ground_;
      continue;
    }
    labels[i] = structure_;
    float least = kNear * kNear;
    const std::int64_t row = pixel / columns, column = pixel % columns;
    for (std::int64_t r = std::max<std::int64_t>(0, row - 2); r <= std::min(rows - 1, row + 2); ++r)
      for (std::int64_t k = column - 4; k <= column + 4; ++k)
      {
        const LabelledPoint& q = cloud.points[static_cast<std::size_t>(r * columns + (k + columns) % columns)];
        if (q.label != structure_ && q.label != object_) continue;
        const float dx = q.x - p.x, dy = q.y - p.y, dz = q.z - p.z, squared = dx * dx + dy * dy + dz * dz;
        if (squared < least) least = squared, labels[i] = q.label;
      }
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
