#pragma once

#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "lidar_panoptic_clustering/tracking/point_tracker.h"
#include "python/array_scan.h"
#include "python/class_labels.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An object of the scan tracked last.
struct ArrayTrack
{
  std::uint32_t id = 0, class_id = 0, instance = 0;  ///< of the track, canonical raw id, in the scan
  float velocity_x = 0.0F, velocity_y = 0.0F;        ///< over ground, in the axes of the fixed frame [m/s]
  float age_s = 0.0F;                                ///< since it was first seen
  std::uint32_t points = 0;                          ///< with coordinates
};

/// Ids that last, from arrays: PointTracker as panoptic_benchmark --track uses it. One thread works at a time.
class ArrayTracker
{
public:
  /// Throws as ClassLabels does, and std::invalid_argument on an unknown parameter or a value outside its range.
  explicit ArrayTracker(const ParameterMap& parameters);

  /// Writes the track of each point, 0 where its instance is 0, and where `voted` is not null the class that its track
  /// had most often. Throws std::invalid_argument with what was expected and found.
  void track(const PointsView& points, const IdsView& labels, const IdsView& instances, double time_s,
             const Eigen::Isometry3d& pose, std::uint32_t* tracks, std::uint32_t* voted);
  /// Of the scan tracked last, in order of their first points; parts of one track stand side by side.
  std::vector<ArrayTrack> objects();
  /// Forgets all tracks and numbers from 1.
  void restart();

  /// Defaults of all parameters.
  static std::vector<ParameterInfo> describe();

private:
  std::mutex mutex_;
  std::unique_ptr<ClassLabels> labels_;
  std::unique_ptr<PointTracker> tracker_;
  std::vector<ScanPoint> buffer_;
  std::vector<std::uint32_t> classes_, instances_;
  std::int64_t stamp_us_ = 0;
  bool has_scan_ = false;
};

/// Ground, structure and objects from arrays, without a network: GroundLabeler. One thread works at a time.
class ArrayGroundLabeler
{
public:
  /// Throws std::invalid_argument on an unknown parameter or a value outside its range.
  explicit ArrayGroundLabeler(const ParameterMap& parameters);

  /// Writes a raw id of the class table "object" a point. `ring` may be null. Throws as ArrayScan::place does.
  void label(const PointsView& points, const IdsView* ring, std::uint32_t* labels);
  /// Of the last scan.
  GroundReport ground();

  /// Defaults of all parameters.
  static std::vector<ParameterInfo> describe();

private:
  std::mutex mutex_;
  std::unique_ptr<ArrayScan> scan_;
  std::unique_ptr<GroundLabeler> labeler_;
  std::vector<std::uint32_t> labels_;
};
}  // namespace lidar_panoptic_clustering
