#pragma once

#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/tracking/point_tracker.h"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Gives the labels of a sequence's scans ids that last, by the data set's poses and times.
class LabelTracker
{
public:
  explicit LabelTracker(const std::shared_ptr<const ClassTable>& table) : table_(table), tracker_(table) {}

  /// Begins a sequence, whose ids are numbered from 1. Without poses objects are followed in the sensor's frame,
  /// without times at 10 scans a second.
  void start(const SemanticKittiSequence& sequence)
  {
    tracker_.tracker().restart();
    poses_ = sequence.readPoses();
    times_ = sequence.readTimes();
  }

  /// Exchanges the instances of `labels`, a prediction of scan number `scan`, for the ids of their tracks, and where
  /// the vote over time says so the classes too. Scans come in order. Throws std::runtime_error where the ids do not
  /// fit the 16 bits of a label file.
  void track(std::size_t scan, const std::vector<ScanPoint>& points, std::vector<std::uint32_t>& labels)
  {
    const double time = times_.empty() ? 0.1 * static_cast<double>(scan) : times_[scan];
    tracker_.begin(std::llround(1e6 * time), poses_.empty() ? Eigen::Isometry3d::Identity() : poses_[scan]);
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (rawInstance(labels[i]) != 0)
        tracker_.add(rawInstance(labels[i]), table_->find(rawClass(labels[i])), points[i].x, points[i].y, points[i].z);
    tracker_.finish();
    std::size_t next = 0;
    for (std::uint32_t& label : labels)
    {
      if (rawInstance(label) == 0) continue;
      const TrackedObject& object = tracker_.objectOf(next++);
      if (object.track > 0xFFFFU)
        throw std::runtime_error("track " + std::to_string(object.track) +
                                 " does not fit the 16 bits that a label file has for it (65535 at most)");
      const ClassIndex own = table_->find(rawClass(label));
      const std::uint32_t class_id =
          own == object.class_index ? rawClass(label) : (*table_)[object.class_index].ids.front();
      label = object.track << 16U | class_id;
    }
  }

private:
  std::shared_ptr<const ClassTable> table_;
  PointTracker tracker_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<double> times_;
};
}  // namespace lidar_panoptic_clustering
