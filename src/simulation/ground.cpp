#include "lidar_panoptic_clustering/simulation/ground.h"

#include "lidar_panoptic_clustering/simulation/labels.h"
#include "lidar_panoptic_clustering/simulation/random.h"

#include <algorithm>
#include <cmath>

namespace lidar_panoptic_clustering::simulation
{
namespace
{
constexpr double kYardLength = 9.0;
constexpr double kDashPeriod = 9.0, kDashLength = 3.0;

Surface stuff(std::uint32_t label, float reflectivity)
{
  return {label, 0, reflectivity, 0.0F, 0.0F};
}
}  // namespace

Ground::Ground(const Course& course, std::uint64_t seed, const Pose& sensor, double reach_m)
    : seed_(seed),
      station_(sensor.x),
      reach_(std::ceil(reach_m) + 1.0),
      height_(static_cast<float>(sensor.z)),
      cosine_(static_cast<float>(std::cos(sensor.yaw))),
      sine_(static_cast<float>(std::sin(sensor.yaw)))
{
  for (double ahead = -reach_; ahead <= reach_; ahead += 1.0)
  {
    const double here = course.centerY(station_ + ahead), slope = course.centerY(station_ + ahead + 1.0) - here;
    pieces_.push_back({static_cast<float>(here - sensor.y), static_cast<float>(slope),
                       static_cast<float>(1.0 / std::sqrt(1.0 + slope * slope))});
  }
}

Ground::Place Ground::place(const Eigen::Vector3f& point) const
{
  const float east = cosine_ * point.x() - sine_ * point.y(), north = sine_ * point.x() + cosine_ * point.y();
  const float index = std::clamp(east + static_cast<float>(reach_), 0.0F, static_cast<float>(pieces_.size() - 1));
  const auto i = static_cast<std::size_t>(index);
  const Piece& piece = pieces_[i];
  return {east, (north - piece.center_y - (index - static_cast<float>(i)) * piece.slope) * piece.cosine};
}

GroundHit Ground::hit(const Eigen::Vector3f& direction, std::uint64_t beam_key) const
{
  const float down = -direction.z();
  const float to_curb_height = (height_ - static_cast<float>(kCurbHeight)) / down;
  const Place high = place(to_curb_height * direction);
  if (std::abs(high.offset) >= static_cast<float>(kCurb))
  {
    const Surface surface = surfaceAt(high);
    const float sink = surface.label == label::kTerrain ? fraction(beam_key, 2) * kGrassHeight / down : 0.0F;
    return {to_curb_height - sink, down, surface};
  }

  const float to_road = height_ / down;
  const Place low = place(to_road * direction);
  if (std::abs(low.offset) <= static_cast<float>(kCurb)) return {to_road, down, surfaceAt(low)};

  // above the road at the curb's height, beyond the curb at the road's: the beam ends on the curb's face between
  const float step = std::abs(low.offset) - std::abs(high.offset);
  const float share = (static_cast<float>(kCurb) - std::abs(high.offset)) / step;
  const float depth = to_road - to_curb_height;
  return {to_curb_height + share * depth, std::min(1.0F, step / depth), stuff(label::kSidewalk, 0.3F)};
}

Surface Ground::surfaceAt(const Place& place) const
{
  const double offset = std::abs(place.offset), station = station_ + place.station;
  if (offset < kMarkingHalfWidth && station - kDashPeriod * std::floor(station / kDashPeriod) < kDashLength)
    return stuff(label::kLaneMarking, 0.7F);
  if (offset < kRoadEdge) return stuff(label::kRoad, 0.25F);
  if (offset < kCurb) return stuff(label::kParking, 0.2F);
  if (offset < kSidewalkEdge) return stuff(label::kSidewalk, 0.35F);

  const auto yard = static_cast<std::int64_t>(std::floor(station / kYardLength)) * 2 + (place.offset > 0.0F ? 1 : 0);
  const float kind = fraction(hash(seed_, static_cast<std::uint64_t>(yard)), 0);
  if (kind < 0.12F) return stuff(label::kSidewalk, 0.35F);
  if (kind < 0.24F) return stuff(label::kOtherGround, 0.3F);
  return stuff(label::kTerrain, 0.45F);
}
}  // namespace lidar_panoptic_clustering::simulation
