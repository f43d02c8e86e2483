#pragma once

#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"
#include "lidar_panoptic_clustering/projection/hidden_points.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"
#include "python/array_scan.h"
#include "python/class_labels.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An object of a scan and the box around its points, hidden ones included.
struct ArrayObject
{
  std::uint32_t id = 0, class_id = 0;  ///< from 1; canonical raw id of the class table
  InstanceBox box;                     ///< sensor frame
  std::uint32_t points = 0;            ///< how many of the array's points it has
};

/// The parameters of a segmenter with one algorithm: of its nodelet, of the labels and of the layout.
/// Throws std::invalid_argument on an unknown algorithm.
std::vector<ParameterInfo> segmenterParameters(const std::string& algorithm);

/// Arrays of points and labels in, instances out: projected, clustered and carried back to all points as
/// panoptic_benchmark does it. May be called from several threads, one at a time works.
class ArraySegmenter
{
public:
  /// Throws std::invalid_argument or std::runtime_error on an unknown algorithm, parameter or table, and on a value
  /// outside its range, with what there is.
  ArraySegmenter(const std::string& algorithm, const ParameterMap& parameters);

  /// Writes an instance a point of the array, row-major: 1..n, 0 for what is no thing; and where `voted` is not null a
  /// class a point: its own, or the canonical id of the class that its instance was voted to have.
  ///
  /// `ring` may be null. Throws std::invalid_argument with what was expected and found where points or labels cannot be
  /// used. Takes what projection, clustering and hidden points take.
  void segment(const PointsView& points, const IdsView& labels, const IdsView* ring, std::uint32_t* instances,
               std::uint32_t* voted);

  /// Of the scan segmented last, by id - 1; none before the first and after one that was refused.
  std::vector<ArrayObject> objects();

  /// As given.
  const std::string& algorithm() const { return algorithm_; }
  /// As given.
  const ParameterMap& parameters() const { return parameters_; }

private:
  void carryBack();
  void keepObjects(std::uint32_t* instances);
  void vote(std::uint32_t* voted) const;

  std::string algorithm_;
  ParameterMap parameters_;
  std::mutex mutex_;
  std::unique_ptr<ClassLabels> labels_;
  std::unique_ptr<ArrayScan> scan_;
  std::unique_ptr<FramePipeline> pipeline_;
  std::optional<HiddenPointLabeller> hidden_points_;
  std::vector<std::uint32_t> classes_, instance_of_pixel_, instance_;
  InstanceBoxes boxes_;

  /// Of the scan segmented last, for objects(): each object without its box, and the points that have coordinates.
  std::vector<ArrayObject> objects_;
  ThingScan things_;
  Instances things_of_;
};
}  // namespace lidar_panoptic_clustering
