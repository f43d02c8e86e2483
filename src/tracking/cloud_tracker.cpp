#include "lidar_panoptic_clustering/tracking/cloud_tracker.h"

#include "lidar_panoptic_clustering/core/color_series.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kPi = 3.14159265F;
constexpr std::uint32_t kNone = VoxelIndex::kNone;

VoxelKey keyOf(std::uint32_t track)
{
  return {static_cast<std::int32_t>(track & 0xFFFFU), static_cast<std::int32_t>(track >> 16U), 0};
}

double secondsSince(std::int64_t then_us, std::int64_t now_us)
{
  return std::max(0.0, 1e-6 * static_cast<double>(now_us - then_us));
}

/// The first point from `i` on before which none is of an instance; eight at a time, as most points of a scan are of
/// none and a branch a point is what reading them costs.
std::uint32_t skipStuff(const PanopticPoint* points, std::uint32_t i, std::uint32_t end)
{
  constexpr std::uint32_t kStep = 8;
  for (; i + kStep <= end; i += kStep)
  {
    std::uint32_t any = 0;
    for (std::uint32_t k = 0; k < kStep; ++k) any |= points[i + k].instance;
    if (any != 0) break;
  }
  return i;
}

/// The rectangle is the same from either end: the way its object drives tells which is the front.
void pointAlong(const Eigen::Vector3d& velocity, InstanceBox& box)
{
  constexpr double kDrives = 1.0;  // [m/s]; below, the direction is noise
  if (velocity.head<2>().norm() < kDrives) return;
  if (velocity.x() * std::cos(box.yaw) + velocity.y() * std::sin(box.yaw) < 0.0) box.yaw += box.yaw > 0.0F ? -kPi : kPi;
}
}  // namespace

CloudTracker::CloudTracker(std::shared_ptr<const ClassTable> table, const TrackerConfig& config)
    : table_(table), tracker_(table, config)
{
}

void CloudTracker::reset()
{
  tracker_.tracker().reset();
  memory_.clear();
}

void CloudTracker::follow(const PanopticCloud& cloud, std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor)
{
  begin(cloud, stamp_us, fixed_from_sensor);
  take(cloud.points.data(), 0, static_cast<std::uint32_t>(cloud_size_));
  finish();
}

void CloudTracker::follow(const PanopticCloud& cloud, std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor,
                          PanopticCloud& out)
{
  constexpr std::uint32_t kBlock = 4096;  // points that are still in the cache after they were copied
  begin(cloud, stamp_us, fixed_from_sensor);
  out.header = cloud.header;
  out.width = cloud.width, out.height = cloud.height, out.is_dense = cloud.is_dense;
  out.sensor_origin_ = cloud.sensor_origin_, out.sensor_orientation_ = cloud.sensor_orientation_;
  const auto size = static_cast<std::uint32_t>(cloud_size_);
  out.points.resize(size);
  for (std::uint32_t first = 0; first < size; first += kBlock)
  {
    const std::uint32_t end = std::min(size, first + kBlock);
    std::copy(cloud.points.begin() + first, cloud.points.begin() + end, out.points.begin() + first);
    take(out.points.data(), first, end);
  }
  finish();
  paintThings(out);
}

void CloudTracker::begin(const PanopticCloud& cloud, std::int64_t stamp_us, const Eigen::Isometry3d& fixed_from_sensor)
{
  if (cloud.size() != std::size_t{cloud.width} * cloud.height)
    throw std::invalid_argument("expected width x height points, found " + std::to_string(cloud.width) + " x " +
                                std::to_string(cloud.height) + " and " + std::to_string(cloud.size()) + " points");
  stamp_us_ = stamp_us;
  pose_ = fixed_from_sensor;
  cloud_size_ = cloud.size();
  unknown_points_ = 0;
  listed_ = false;
  points_.clear();
  tracker_.begin(stamp_us, fixed_from_sensor);
}

/// Hands the points of instances from `begin` to `end` to the tracker.
void CloudTracker::take(const PanopticPoint* points, std::uint32_t begin, std::uint32_t end)
{
  for (std::uint32_t i = begin; i < end; ++i)
  {
    if (points[i].instance == 0) i = skipStuff(points, i, end);
    if (i == end) break;
    const PanopticPoint& point = points[i];
    if (point.instance == 0) continue;
    const ClassIndex class_index = table_->find(point.label);
    if (class_index == kUnknownClass) ++unknown_points_;
    points_.push_back(i);
    tracker_.add(point.instance, class_index, point.x, point.y, point.z);
  }
}

void CloudTracker::finish()
{
  tracker_.finish();
  paints_.clear();
  for (const TrackedObject& object : tracker_.objects())
  {
    const auto& ids = (*table_)[object.class_index].ids;
    const std::uint32_t label = ids.empty() ? 0 : ids.front();
    paints_.push_back({object.track, seriesColor(object.track), object.class_index, !ids.empty(), label});
  }
}

void CloudTracker::requireSame(const PanopticCloud& cloud) const
{
  if (cloud.size() != cloud_size_)
    throw std::invalid_argument("expected the cloud of " + std::to_string(cloud_size_) +
                                " points that was followed, found " + std::to_string(cloud.size()));
}

void CloudTracker::paint(const PanopticCloud& cloud, PanopticCloud& out) const
{
  requireSame(cloud);
  out = cloud;
  paintThings(out);
}

/// Ids, colours and voted classes on a copy of the cloud that was followed.
void CloudTracker::paintThings(PanopticCloud& out) const
{
  for (std::size_t k = 0; k < points_.size(); ++k)
  {
    const Paint& paint = paints_[tracker_.placeOf(k)];
    PanopticPoint& point = out.points[points_[k]];
    point.instance = paint.track;
    point.rgb = paint.rgb;
    if (paint.has_label && table_->find(point.label) != paint.class_index) point.label = paint.label;
  }
}

const std::vector<ListedTrack>& CloudTracker::list(const PanopticCloud& cloud)
{
  requireSame(cloud);
  if (std::exchange(listed_, true)) return list_;
  beginList();
  gather(cloud);
  describe();
  listHidden();
  remember();
  return list_;
}

/// An entry for each track; several observations may be parts of one.
void CloudTracker::beginList()
{
  const auto& objects = tracker_.objects();
  const auto& observations = tracker_.observations();
  list_.clear(), instances_.objects.clear(), largest_.clear(), agreeing_.clear();
  place_of_track_.reset();
  parts_.resize(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
  {
    parts_[i] = {kNone, 0};
    if (observations[i].point_count == 0) continue;  // no coordinates
    const std::uint32_t place = place_of_track_.insert(keyOf(objects[i].track));
    parts_[i].place = place;
    if (place < list_.size()) continue;
    list_.emplace_back();
    list_.back().object = objects[i];
    instances_.objects.emplace_back();
    largest_.push_back(0), agreeing_.push_back(0);
  }
}

void CloudTracker::gather(const PanopticCloud& cloud)
{
  things_.points.clear(), instances_.id.clear();
  for (std::size_t k = 0; k < points_.size(); ++k)
  {
    Part& part = parts_[tracker_.placeOf(k)];
    const PanopticPoint& p = cloud.points[points_[k]];
    part.instance = p.instance;
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    things_.points.push_back({p.x, p.y, p.z, 0});
    instances_.id.push_back(part.place + 1);
    ++instances_.objects[part.place].point_count;
    if (table_->find(p.label) == list_[part.place].object.class_index) ++agreeing_[part.place];
  }
}

void CloudTracker::describe()
{
  const auto& observations = tracker_.observations();
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (const Part part = parts_[i]; part.place != kNone && observations[i].point_count > largest_[part.place])
    {
      largest_[part.place] = observations[i].point_count;
      list_[part.place].instance = part.instance;
    }
  const auto& boxes = boxes_.fit(things_, instances_);
  for (std::size_t place = 0; place < list_.size(); ++place)
  {
    ListedTrack& listed = list_[place];
    listed.point_count = instances_.objects[place].point_count;
    listed.class_share = static_cast<float>(agreeing_[place]) / static_cast<float>(listed.point_count);
    listed.box = boxes[place];
    listed.since_first_seen_s = secondsSince(listed.object.first_seen_us, stamp_us_);
    intoSensorAxes(listed);
    pointAlong(listed.velocity, listed.box);
  }
}

void CloudTracker::intoSensorAxes(ListedTrack& listed) const
{
  const Eigen::Matrix3d axes = pose_.linear().transpose();
  const auto turned = [&axes](const Eigen::Matrix2d& covariance) -> Eigen::Matrix3d
  {
    Eigen::Matrix3d in_space = Eigen::Matrix3d::Zero();
    in_space.topLeftCorner<2, 2>() = covariance;
    return axes * in_space * axes.transpose();
  };
  const TrackedObject& object = listed.object;
  const double hidden = listed.since_last_seen_s;
  listed.velocity = axes * Eigen::Vector3d(object.velocity.x(), object.velocity.y(), 0.0);
  listed.velocity_covariance = turned(object.velocity_covariance);
  listed.position_covariance = turned(object.position_covariance + hidden * hidden * object.velocity_covariance);
}

/// Those that are not seen, where they should be by now.
void CloudTracker::listHidden()
{
  constexpr std::uint32_t kFewest = 3;  // scans that make a track more than a fragment
  const Eigen::Isometry3d sensor_from_fixed = pose_.inverse();
  for (const Memory& memory : memory_)
  {
    if (memory.object.scans < kFewest || place_of_track_.find(keyOf(memory.track)) != kNone) continue;
    if (!tracker_.tracker().isAlive(memory.track)) continue;
    ListedTrack listed;
    listed.object = memory.object;
    listed.class_share = memory.class_share;
    listed.since_first_seen_s = secondsSince(memory.object.first_seen_us, stamp_us_);
    listed.since_last_seen_s = secondsSince(memory.object.last_seen_us, stamp_us_);
    intoSensorAxes(listed);
    const Eigen::Vector3d way(memory.object.velocity.x(), memory.object.velocity.y(), 0.0);
    const Eigen::Vector3d center = sensor_from_fixed * (memory.center + listed.since_last_seen_s * way);
    const Eigen::Vector3d axis = sensor_from_fixed.linear() * memory.axis;
    listed.box = memory.box;
    listed.box.x = static_cast<float>(center.x());
    listed.box.y = static_cast<float>(center.y());
    listed.box.z = static_cast<float>(center.z());
    listed.box.yaw = static_cast<float>(std::atan2(axis.y(), axis.x()));
    list_.push_back(listed);
  }
}

void CloudTracker::remember()
{
  next_memory_.clear();
  for (const ListedTrack& listed : list_)
    if (listed.instance != 0)
    {
      const InstanceBox& box = listed.box;
      next_memory_.push_back({listed.object.track, listed.object, listed.class_share, box,
                              pose_ * Eigen::Vector3d(box.x, box.y, box.z),
                              pose_.linear() * Eigen::Vector3d(std::cos(box.yaw), std::sin(box.yaw), 0.0)});
    }
  for (const Memory& memory : memory_)
    if (place_of_track_.find(keyOf(memory.track)) == kNone && tracker_.tracker().isAlive(memory.track))
      next_memory_.push_back(memory);
  std::sort(next_memory_.begin(), next_memory_.end(),
            [](const Memory& a, const Memory& b) { return a.track < b.track; });
  std::swap(memory_, next_memory_);
}
}  // namespace lidar_panoptic_clustering
