#include "lidar_panoptic_clustering/labelling/component_judge.h"

#include <algorithm>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPersonHeight = 2.2F;  // [m] with a hat on; cars are lower, vans, trucks and buses higher
constexpr float kHovering = 2.0F;      // [m] nothing that drives or walks ends above
constexpr float kLowest = 0.4F;        // [m] nothing that drives or walks ends below; kerbs, plants and stones do
constexpr float kWidest = 3.2F;        // [m] the European limit of 2.55 with mirrors
constexpr float kSmooth = 0.32F;       // share of rough triples in sheet metal with windows
constexpr float kCarLength = 7.0F;     // [m] with a trailer hitch, or two that stand close
constexpr std::uint32_t kFewestReturns = 4, kFewestFeet = 5, kFewestTriples = 20;
constexpr std::uint32_t kMostHidden =
    4;  // hidden columns of a foot to one that is seen: what few tell is not the whole

/// Below what the whole times `least` is; false where there is nothing.
bool isBelow(float least, std::uint32_t part, std::uint32_t whole)
{
  return static_cast<float>(part) < least * static_cast<float>(whole);
}

float share(std::uint32_t part, std::uint32_t whole)
{
  return static_cast<float>(part) / static_cast<float>(whole);
}

/// The share of rough triples; few tell nothing.
float roughness(const ScanComponent& c)
{
  return c.triples >= kFewestTriples ? share(c.rough_triples, c.triples) : 0.0F;
}
}  // namespace

const std::vector<std::string>& structureBiasNames()
{
  static const std::vector<std::string> names = {"strict", "balanced", "keep_objects"};
  return names;
}

StructureBias structureBiasFromName(const std::string& name)
{
  const auto& names = structureBiasNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw std::invalid_argument("structure: expected strict, balanced or keep_objects, found '" + name + "'");
  return static_cast<StructureBias>(found - names.begin());
}

/// What a component is judged by.
struct ComponentJudge::Appearance
{
  explicit Appearance(const ScanComponent& c)
      : size(c.footprint.smallestRectangle()),
        tall(c.top > kPersonHeight),
        maybe_tall(tall || c.open_top),
        has_feet(c.blocked + c.undercut >= kFewestFeet && kMostHidden * (c.blocked + c.undercut) >= c.hidden),
        undercut(has_feet ? share(c.undercut, c.blocked + c.undercut) : 0.0F),
        rough(roughness(c))
  {
  }

  RectangleSize size;
  bool tall, maybe_tall;
  bool has_feet;
  float undercut, rough;  ///< shares
};

ComponentJudge::ComponentJudge(const Limits& limits, StructureBias bias) : limits_(limits), bargain_(bargainOf(bias)) {}

ComponentJudge::Bargain ComponentJudge::bargainOf(StructureBias bias)
{
  switch (bias)
  {
    case StructureBias::kStrict:
      return {0.33F, 1.3F, 0.3F, 0.6F, 0.4F, 0.6F, 0.25F};
    case StructureBias::kBalanced:
      return {0.42F, 0.5F, 0.2F, 0.5F, 0.15F, 0.5F, 0.15F};
    case StructureBias::kKeepObjects:
      return {0.5F, 0.3F, 0.1F, 0.35F, 0.1F, 0.4F, 0.0F};
  }
  throw std::invalid_argument("structure: expected one of its values");
}

bool ComponentJudge::isStructure(const ScanComponent& c) const
{
  if (c.point_count < kFewestReturns) return true;
  if (c.top > limits_.height || c.top < kLowest || c.bottom > kHovering) return true;
  if (!c.footprint.fits(limits_.length, kWidest)) return true;
  const Appearance appearance(c);
  return isPole(c, appearance) || isFoliage(appearance) || isWall(c, appearance) || isBehind(c, appearance);
}

bool ComponentJudge::isPole(const ScanComponent& c, const Appearance& a)
{
  if (a.maybe_tall && a.size.length < 1.0F && (a.tall || c.bottom > 0.5F)) return true;
  // thinner than a person, from the side too: bollards, posts, small trunks; posts of signs are 0.06 to 0.1 m thick
  const bool stands = c.bottom < 0.5F && c.top > 1.0F && c.blocked + c.undercut > 0;
  if (stands && a.size.length < 0.2F) return true;
  return c.top > 1.5F && (a.size.length < 0.18F || (a.size.length < 0.6F && a.size.width < 0.1F));
}

bool ComponentJudge::isFoliage(const Appearance& a) const
{
  const bool may_be_rider = a.undercut >= 0.5F && a.size.length < 2.2F && !a.tall;
  // seats and what lies behind them, through the windows; a bush of that width stands on the ground
  const bool may_be_car = a.undercut >= 0.5F && a.size.width > 1.0F && a.size.length < 5.0F && !a.maybe_tall;
  return a.rough > bargain_.most_rough && !may_be_rider && !may_be_car;
}

bool ComponentJudge::isWall(const ScanComponent& c, const Appearance& a) const
{
  // a wheel or a sill near the ground may be all that is seen of a car's foot
  const bool has_cars_outline = a.size.width > 1.3F && a.size.length < kCarLength;
  if (a.maybe_tall && a.has_feet && a.undercut < (has_cars_outline ? bargain_.cars : bargain_.undercut)) return true;
  // the wheels of a lorry or a bus block less of its length than a car's do
  constexpr float kLorry = 1.3F;  // times the share
  if (a.maybe_tall && a.has_feet && a.size.length > kCarLength && a.undercut < kLorry * bargain_.undercut) return true;
  constexpr float kLow = 0.7F;  // of the share: no foot of something low is hidden by its own width
  if (!has_cars_outline && a.size.length > 1.5F && a.has_feet && a.undercut < kLow * bargain_.undercut) return true;
  // seen over something that hides its foot
  if (a.maybe_tall && !a.has_feet && c.bottom > 0.25F && a.size.width < bargain_.hidden_foot_width) return true;
  const bool is_hidden = a.maybe_tall && !a.has_feet && c.hidden > c.blocked + c.undercut;
  if (is_hidden && isBelow(bargain_.least_free_tall, c.free_ends, c.ends)) return true;
  // fences and hedges: no vehicle is so long, as low as a car, and shows no width
  return !a.maybe_tall && a.size.length > 6.0F && a.size.width < 0.3F;
}

bool ComponentJudge::isBehind(const ScanComponent& c, const Appearance& a) const
{
  const bool has_depth = a.size.width > 0.7F && !a.maybe_tall;  // two sides of a car, where a wall shows one
  const bool stands_on_wheels = a.has_feet && a.undercut >= bargain_.undercut;
  return !has_depth && !stands_on_wheels && isBelow(bargain_.least_in_front, c.free_ends, c.ends);
}

bool ComponentJudge::isSmooth(const ScanComponent& c) const
{
  return roughness(c) <= kSmooth;
}

bool ComponentJudge::isVehicle(const ScanComponent& c) const
{
  constexpr float kRiderLength = 2.2F, kRiderWidth = 1.1F;  // [m] a motorcycle's or a cargo bicycle's, with elbows
  const Appearance a(c);
  if (!a.maybe_tall && a.size.length < kRiderLength && a.size.width < kRiderWidth) return true;
  if (a.rough > kSmooth) return false;
  return a.has_feet ? a.undercut >= 0.5F : a.size.width > 1.2F && a.size.length < kCarLength;
}

bool ComponentJudge::mayHoldPerson(const HeightRange& part)
{
  constexpr std::uint32_t kFewest = 10;
  if (part.point_count < kFewest || part.top < 1.2F || part.top > 2.1F) return false;  // sitting to tall
  return part.top - part.bottom >= 0.5F && part.bottom <= 1.1F && !part.open_top;
}

bool ComponentJudge::isPersonCutOff(const ScanComponent& part) const
{
  constexpr float kHalfChest = 0.12F;  // [m] of its depth is seen
  return isPerson(part) && part.footprint.smallestRectangle().width > kHalfChest;
}

bool ComponentJudge::isPerson(const ScanComponent& c) const
{
  constexpr float kMostRough = 0.6F;  // bags, arms and legs
  if (!mayHoldPerson(c)) return false;
  // beams that came by underneath: a window's frame, a mirror; legs stand on the ground, or something hides them
  constexpr float kHangs = 0.35F;
  constexpr std::uint32_t kBeams = 2;
  if (c.bottom > kHangs && c.undercut > c.blocked + kBeams) return false;
  const RectangleSize size = c.footprint.smallestRectangle();
  if (size.length < 0.3F || size.length > 1.1F || size.width < 0.05F || size.width > 0.9F) return false;
  if (isBelow(bargain_.least_free, c.free_ends, c.ends)) return false;
  return roughness(c) < kMostRough;
}
}  // namespace lidar_panoptic_clustering
