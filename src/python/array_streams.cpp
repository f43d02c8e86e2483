#include "python/array_streams.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
struct TrackConfig
{
  ClassLabelsConfig labels;
  TrackerConfig tracker;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    ClassLabelsConfig::visit(self.labels, visitor);
    TrackerConfig::visit(self.tracker, visitor);
  }
};

struct GroundConfig
{
  ArrayScanConfig scan;
  GroundLabelerConfig labeler;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    GroundLabelerConfig::visit(self.labeler, visitor);
    ArrayScanConfig::visit(self.scan, visitor);
  }
};
}  // namespace

ArrayTracker::ArrayTracker(const ParameterMap& parameters)
{
  TrackConfig config;
  applyParameters(config, parameters);
  labels_ = std::make_unique<ClassLabels>(config.labels);
  tracker_ = std::make_unique<PointTracker>(labels_->table(), config.tracker);
}

std::vector<ParameterInfo> ArrayTracker::describe()
{
  return describeParameters(TrackConfig());
}

void ArrayTracker::track(const PointsView& points, const IdsView& labels, const IdsView& instances, double time_s,
                         const Eigen::Isometry3d& pose, std::uint32_t* tracks, std::uint32_t* voted)
{
  if (!(std::abs(time_s) < 1e12))
    throw std::invalid_argument("time_s: expected a number of seconds, found " + std::to_string(time_s));
  const std::lock_guard<std::mutex> lock(mutex_);
  has_scan_ = false;
  const ScanPoints at = readPoints(points, buffer_);
  labels_->read(labels, classes_);
  readIds(instances, "instances", instances_);
  const ClassTable& table = *labels_->table();
  stamp_us_ = std::llround(1e6 * time_s);
  tracker_->begin(stamp_us_, pose);
  for (std::size_t i = 0; i < at.size(); ++i)
    if (instances_[i] != 0) tracker_->add(instances_[i], table.find(classes_[i]), at[i].x, at[i].y, at[i].z);
  tracker_->finish();
  has_scan_ = true;
  std::size_t next = 0;
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    tracks[i] = 0;
    if (voted != nullptr) voted[i] = classes_[i];
    if (instances_[i] == 0) continue;
    const TrackedObject& object = tracker_->objectOf(next++);
    tracks[i] = object.track;
    if (voted != nullptr && table.find(classes_[i]) != object.class_index)
      voted[i] = table[object.class_index].ids.front();
  }
}

std::vector<ArrayTrack> ArrayTracker::objects()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<ArrayTrack> objects;
  if (!has_scan_) return objects;
  const ClassTable& table = *labels_->table();
  for (std::size_t i = 0; i < tracker_->objects().size(); ++i)
  {
    const TrackedObject& object = tracker_->objects()[i];
    const Observation& seen = tracker_->observations()[i];
    const auto& ids = table[object.class_index].ids;
    objects.push_back({object.track, ids.empty() ? 0 : ids.front(), seen.instance,
                       static_cast<float>(object.velocity.x()), static_cast<float>(object.velocity.y()),
                       static_cast<float>(1e-6 * static_cast<double>(stamp_us_ - object.first_seen_us)),
                       seen.point_count});
  }
  return objects;
}

void ArrayTracker::restart()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  has_scan_ = false;
  tracker_->tracker().restart();
}

ArrayGroundLabeler::ArrayGroundLabeler(const ParameterMap& parameters)
{
  GroundConfig config;
  applyParameters(config, parameters);
  scan_ = std::make_unique<ArrayScan>(config.scan);
  labeler_ = std::make_unique<GroundLabeler>(config.labeler);
}

std::vector<ParameterInfo> ArrayGroundLabeler::describe()
{
  return describeParameters(GroundConfig());
}

void ArrayGroundLabeler::label(const PointsView& points, const IdsView* ring, std::uint32_t* labels)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  scan_->place(points, {}, ring);
  OrganizedScan& scan = scan_->scan();
  if (scan_->isImage())
  {
    labeler_->label(scan.image.cloud);
    for (const LabelledPoint& pixel : scan.image.cloud.points) *labels++ = pixel.label;
    return;
  }
  if (scan.layout == Layout::kMerged)
    labeler_->labelUnordered(scan.points, labels_);
  else
  {
    labeler_->label(scan.image.cloud);
    const ScanPoints at = scan_->points();
    if (at.begin() != scan.points.data()) scan.points.assign(at.begin(), at.end());
    labeler_->labelPoints(scan, labels_);
  }
  std::copy(labels_.begin(), labels_.end(), labels);
}

GroundReport ArrayGroundLabeler::ground()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return labeler_->ground();
}
}  // namespace lidar_panoptic_clustering
