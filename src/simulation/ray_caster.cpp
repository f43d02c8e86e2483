#include "lidar_panoptic_clustering/simulation/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace lidar_panoptic_clustering::simulation
{
namespace
{
constexpr float kPi = 3.14159265F;
constexpr std::uint64_t kFirstSolidDraw = 16;  // those before belong to the beam itself
constexpr float kSlack = 1e-3F;                // bounds are widened by this much, so that rounding never loses a beam

/// Squared distance from the origin to the segment a-b.
float squaredDistanceToSegment(const Eigen::Vector2f& a, const Eigen::Vector2f& b)
{
  const Eigen::Vector2f ab = b - a;
  const float length = ab.squaredNorm();
  const float t = length > 0.0F ? std::clamp(-a.dot(ab) / length, 0.0F, 1.0F) : 0.0F;
  return (a + t * ab).squaredNorm();
}

/// A bounding box seen from the origin.
struct Silhouette
{
  float low_z, high_z;                ///< [m]
  float nearest, farthest;            ///< horizontal distance [m]
  float first_azimuth, last_azimuth;  ///< last may exceed pi; a full turn when the box is above or below the origin
};

Silhouette silhouette(const Eigen::Vector3f& center, const Eigen::Matrix3f& half_axes)
{
  std::array<Eigen::Vector3f, 8> corners;
  for (int i = 0; i < 8; ++i)
    corners[i] = center + half_axes * Eigen::Vector3f((i & 1) != 0 ? 1.0F : -1.0F, (i & 2) != 0 ? 1.0F : -1.0F,
                                                      (i & 4) != 0 ? 1.0F : -1.0F);
  const float middle = std::atan2(center.y(), center.x());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Silhouette box{kInfinity, -kInfinity, kInfinity, 0.0F, kInfinity, -kInfinity};
  for (int i = 0; i < 8; ++i)
  {
    const auto& corner = corners[i];
    box.low_z = std::min(box.low_z, corner.z());
    box.high_z = std::max(box.high_z, corner.z());
    box.farthest = std::max(box.farthest, corner.head<2>().squaredNorm());
    for (const int bit : {1, 2, 4})
      if ((i & bit) == 0)
        box.nearest = std::min(box.nearest, squaredDistanceToSegment(corner.head<2>(), corners[i | bit].head<2>()));

    const float azimuth = std::remainder(std::atan2(corner.y(), corner.x()) - middle, 2.0F * kPi);
    box.first_azimuth = std::min(box.first_azimuth, azimuth);
    box.last_azimuth = std::max(box.last_azimuth, azimuth);
  }
  box.nearest = std::sqrt(box.nearest);
  box.farthest = std::sqrt(box.farthest);
  // seen from outside, a convex body covers less than half a turn
  if (box.last_azimuth - box.first_azimuth >= kPi - kSlack)
    box.nearest = 0.0F, box.first_azimuth = -kPi, box.last_azimuth = kPi;
  box.first_azimuth += middle;
  box.last_azimuth += middle;
  return box;
}
}  // namespace

RayCaster::RayCaster(const SensorModel& model)
    : rows_(model.rows()),
      columns_(model.columns),
      max_range_m_(model.max_range_m),
      fov_rad_(static_cast<float>(model.horizontal_fov_rad)),
      full_turn_(model.fullTurn())
{
  validateSensorModel(model);
  for (const float elevation : model.elevations_rad)
  {
    tangents_.push_back(std::tan(elevation));
    const float to_ground = elevation < 0.0F ? model.mount_height_m / std::sin(-elevation) : max_range_m_;
    limits_.push_back(std::min(max_range_m_, to_ground));
  }
  directions_.reserve(std::size_t{rows_} * columns_);
  for (std::uint32_t column = 0; column < columns_; ++column)
    for (const float elevation : model.elevations_rad)
    {
      const float azimuth = model.azimuth(column), horizontal = std::cos(elevation);
      directions_.emplace_back(horizontal * std::cos(azimuth), horizontal * std::sin(azimuth), std::sin(elevation));
    }
  ends_.resize(directions_.size());
}

float RayCaster::range(const Target& target, const Eigen::Vector3f& direction, std::uint64_t beam_key)
{
  constexpr float kMiss = std::numeric_limits<float>::infinity();
  Chord chord;
  if (!intersect(target.shape, target.origin, target.to_unit * direction, chord) || !(chord.enter > 0.0F)) return kMiss;
  if (target.transmission == 0.0F && target.depth_m == 0.0F) return chord.enter;

  const std::uint64_t bits = draw(beam_key, kFirstSolidDraw + target.solid);
  if (fraction(bits, 0) < target.transmission) return kMiss;
  return chord.enter + fraction(bits, 1) * std::min(target.depth_m, chord.exit - chord.enter);
}

void RayCaster::cast(const std::vector<Solid>& solids, const Pose& sensor, std::uint64_t key)
{
  targets_.clear();
  Target target;
  for (std::uint32_t i = 0; i < solids.size(); ++i)
  {
    target.solid = i;
    if (makeTarget(solids[i], sensor, target)) targets_.push_back(target);
  }
  std::sort(targets_.begin(), targets_.end(),
            [](const Target& a, const Target& b)
            { return a.near_m != b.near_m ? a.near_m < b.near_m : a.solid < b.solid; });

  for (std::uint32_t column = 0; column < columns_; ++column)
    for (std::uint32_t row = 0; row < rows_; ++row) ends_[column * rows_ + row] = {limits_[row], -1};
  for (std::size_t i = 0; i < targets_.size(); ++i) render(targets_[i], static_cast<std::int32_t>(i), key);
}

bool RayCaster::makeTarget(const Solid& solid, const Pose& sensor, Target& target) const
{
  const Eigen::Vector3f offset = (solid.center - Eigen::Vector3d(sensor.x, sensor.y, sensor.z)).template cast<float>();
  if (offset.norm() - solid.half_axes.norm() > max_range_m_) return false;
  if (!(solid.half_axes.colwise().squaredNorm().minCoeff() > 0.0F)) return false;  // nothing to hit

  const auto cosine = static_cast<float>(std::cos(sensor.yaw)), sine = static_cast<float>(std::sin(sensor.yaw));
  Eigen::Matrix3f to_sensor;
  to_sensor << cosine, sine, 0.0F, -sine, cosine, 0.0F, 0.0F, 0.0F, 1.0F;
  const Eigen::Vector3f center = to_sensor * offset;
  const Eigen::Matrix3f half_axes = to_sensor * solid.half_axes;

  const Silhouette box = silhouette(center, half_axes);
  const float below = std::max({0.0F, box.low_z, -box.high_z});
  target.near_m = std::hypot(box.nearest, below) * (1.0F - kSlack) - kSlack;
  if (!boundRows(box.low_z, box.high_z, box.nearest, box.farthest, target)) return false;
  if (!boundColumns(box.first_azimuth, box.last_azimuth, target)) return false;

  target.shape = solid.shape;
  // the axes are orthogonal: each row of the inverse is an axis over its squared length
  for (int i = 0; i < 3; ++i) target.to_unit.row(i) = half_axes.col(i).transpose() / half_axes.col(i).squaredNorm();
  target.origin = -(target.to_unit * center);
  target.transmission = solid.surface.transmission;
  target.depth_m = solid.surface.depth_m;
  return true;
}

bool RayCaster::boundRows(float low_z, float high_z, float nearest_m, float farthest_m, Target& target) const
{
  nearest_m = std::max(0.0F, nearest_m - kSlack), farthest_m += kSlack;
  high_z += kSlack, low_z -= kSlack;
  const float highest = high_z / (high_z > 0.0F ? nearest_m : farthest_m);
  const float lowest = low_z / (low_z < 0.0F ? nearest_m : farthest_m);
  const auto first = std::lower_bound(tangents_.begin(), tangents_.end(), highest, std::greater<>());
  const auto last = std::upper_bound(first, tangents_.end(), lowest, std::greater<>());
  target.row_begin = static_cast<std::uint32_t>(first - tangents_.begin());
  target.row_end = static_cast<std::uint32_t>(last - tangents_.begin());
  return target.row_begin < target.row_end;
}

bool RayCaster::boundColumns(float first_azimuth, float last_azimuth, Target& target) const
{
  // azimuth falls as the column rises
  const float per_radian = static_cast<float>(columns_) / fov_rad_;
  const auto columnsOf = [&](float turn)
  {
    const float left = 0.5F * fov_rad_ + turn;
    return std::make_pair(
        static_cast<std::int32_t>(std::ceil((left - last_azimuth) * per_radian - 0.5F - 0.01F)),
        static_cast<std::int32_t>(std::floor((left - first_azimuth) * per_radian - 0.5F + 0.01F)) + 1);
  };
  const auto columns = static_cast<std::int32_t>(columns_);
  if (full_turn_)  // columns beyond the last wrap around
  {
    const auto [begin, end] = columnsOf(0.0F);
    target.column_begin = ((begin % columns) + columns) % columns;
    target.column_count = std::clamp(end - begin, 0, columns);
    return true;
  }
  std::int32_t first = columns, last = 0;  // what lies behind a wide sector may reach into both of its ends
  for (const float turn : {-2.0F * kPi, 0.0F, 2.0F * kPi})
  {
    const auto [begin, end] = columnsOf(turn);
    if (begin >= columns || end <= 0 || begin >= end) continue;
    first = std::min(first, std::max(begin, 0));
    last = std::max(last, std::min(end, columns));
  }
  target.column_begin = first;
  target.column_count = std::max(0, last - first);
  return target.column_count > 0;
}

void RayCaster::render(const Target& target, std::int32_t index, std::uint64_t key)
{
  auto column = static_cast<std::uint32_t>(target.column_begin);
  for (std::int32_t k = 0; k < target.column_count; ++k, column = column + 1 == columns_ ? 0 : column + 1)
  {
    BeamEnd* ends = &ends_[std::size_t{column} * rows_];
    const Eigen::Vector3f* directions = &directions_[std::size_t{column} * rows_];
    for (std::uint32_t row = target.row_begin; row < target.row_end; ++row)
    {
      if (ends[row].range_m < target.near_m) continue;
      const bool random = target.transmission > 0.0F || target.depth_m > 0.0F;
      const float range_m = range(target, directions[row], random ? beamKey(key, row, column) : 0);
      const bool nearer = range_m < ends[row].range_m;
      const bool tie = range_m == ends[row].range_m && ends[row].target >= 0 &&
                       target.solid < targets_[static_cast<std::size_t>(ends[row].target)].solid;
      if (nearer || tie) ends[row] = {range_m, index};
    }
  }
}
}  // namespace lidar_panoptic_clustering::simulation
