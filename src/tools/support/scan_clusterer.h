#pragma once

#include "lidar_panoptic_clustering/evaluation/frame_times.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"
#include "lidar_panoptic_clustering/projection/hidden_points.h"
#include "tools/support/benchmark_scans.h"
#include "tools/support/benchmark_settings.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// One thread's way from a scan to its predictions: projected once, then clustered by each row through the pipeline
/// the nodelets have, and carried back to all points, hidden ones included.
class ScanClusterer
{
public:
  ScanClusterer(const BenchmarkSettings& settings, const std::shared_ptr<const ClassTable>& table)
      : table_(table), projector_(ProjectionConfig{64, settings.columns}), hidden_points_(table)
  {
    for (const RowSettings& row : settings.rows)
    {
      Algorithm made = makeAlgorithm(row.algorithm, row.allParameters());
      lanes_.push_back({std::make_unique<FramePipeline>(table, made.pipeline, std::move(made.clusterer)), false});
    }
  }

  /// `scan` has to outlive the calls of cluster().
  void project(const BenchmarkScan& scan)
  {
    scan_ = &scan;
    projector_.project(scan.points, scan.classes, projection_);
  }

  /// Writes the labels of the scan's points, as in a prediction file, and the time. `image` gets the painted cloud, a
  /// new one for each scan as in the nodelets. A row's first scan is clustered twice and the second time counts: the
  /// first one only grows buffers.
  void cluster(std::size_t row, PanopticCloud& image, std::vector<std::uint32_t>& labels, FrameTime& time)
  {
    Lane& lane = lanes_[row];
    if (!std::exchange(lane.warm, true)) lane.pipeline->segment(projection_.cloud);
    lane.pipeline->segment(projection_.cloud);
    lane.pipeline->paint(projection_.cloud, image);
    time.points = static_cast<std::uint32_t>(scan_->points.size());
    time.thing_points = static_cast<std::uint32_t>(lane.pipeline->things().size());
    time.cluster_ms = lane.pipeline->times().cluster_ms;
    time.pipeline_ms = lane.pipeline->times().total();

    pixelInstances(lane.pipeline->things(), lane.pipeline->instances(), instance_of_pixel_);
    hidden_points_.label(scan_->points, scan_->classes, projection_, instance_of_pixel_, instance_);
    classes_ = scan_->classes;
    const std::size_t instances = lane.pipeline->instances().count();  // larger ids are hidden points' own
    for (std::size_t k = 0; k < classes_.size(); ++k)
    {
      if (instance_[k] == 0 || instance_[k] > instances) continue;
      const ClassIndex own = table_->find(classes_[k]), voted = lane.pipeline->votedClass(instance_[k], own);
      if (voted != own) classes_[k] = (*table_)[voted].ids[0];
    }
    encodeLabels(classes_, instance_, *table_, labels);
  }

private:
  struct Lane
  {
    std::unique_ptr<FramePipeline> pipeline;
    bool warm;
  };

  std::shared_ptr<const ClassTable> table_;
  PointProjector projector_;
  HiddenPointLabeller hidden_points_;
  std::vector<Lane> lanes_;  ///< by row
  const BenchmarkScan* scan_ = nullptr;
  Projection projection_;
  std::vector<std::uint32_t> instance_of_pixel_, instance_, classes_;
};
}  // namespace lidar_panoptic_clustering
