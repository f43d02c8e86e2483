#pragma once

#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <cstdint>
#include <functional>
#include <string>

namespace lidar_panoptic_clustering
{
struct SequenceBagConfig
{
  std::string dataset, sequence = "00";
  std::string semantics;    ///< folder of predictions whose classes the points get; empty: the true ones
  std::string label_table;  ///< of their ids; empty: the class table
  std::string output;
  std::string class_table = "semantic_kitti";
  std::string frame_id = "velodyne";
  std::string compression = "none";  ///< or lz4, bz2
  std::uint64_t first = 0;           ///< scan
  std::uint64_t count = 0;           ///< scans; 0: to the end
  double start_s = 1316995200.0;     ///< stamp of the sequence's time 0: midnight before KITTI's first drive
  ProjectionConfig projection;       ///< of the ground truth
};

struct SequenceBagSummary
{
  std::uint64_t scans = 0, points = 0, bytes = 0;
  bool labelled = false, ground_truth = false, poses = false;
  std::string doubt;  ///< which other tables the predictions may be of, see PredictedClasses
};

/// Told at the start and after each scan how many are written and how many it will be; false ends the work without a
/// file.
using SequenceBagProgress = std::function<bool(std::uint64_t done, std::uint64_t all)>;

/// Writes a sequence of a SemanticKITTI folder (semantic_kitti.h) as a rosbag file:
///
/// /points: sensor_msgs/PointCloud2, see toPointMessage(), with labels where there are some; /ground_truth: where there
/// are true labels, organised, as SemanticKittiPlayerNodelet publishes it; /tf: world -> frame_id where there are
/// poses. All three of a scan carry its time in times.txt (without: 10 scans a second, as KITTI's lidar turns), counted
/// from `start_s`, in whole microseconds, as that is what a PCL header keeps.
///
/// The file is written aside and renamed: it is there whole or not at all. Throws std::runtime_error or
/// std::invalid_argument with the file or parameter, what was expected and what was found; std::runtime_error
/// "interrupted" where `progress` says so.
SequenceBagSummary writeSequenceBag(const SequenceBagConfig& config, const SequenceBagProgress& progress);
}  // namespace lidar_panoptic_clustering
