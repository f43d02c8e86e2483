#pragma once

#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/refinement/refinement.h"
#include "lidar_panoptic_clustering/tracking/instance_colors.h"

#include <memory>

namespace lidar_panoptic_clustering
{
/// What surrounds the clusterer, whatever the algorithm.
struct PipelineConfig
{
  SelectionConfig selection;    ///< before the clusterer
  RefinementConfig refinement;  ///< behind it

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    SelectionConfig::visit(self.selection, visitor);
    RefinementConfig::visit(self.refinement, visitor);
  }
};

/// Wall time of the stages of one scan [ms].
struct StageTimes
{
  double select_ms = 0.0, cluster_ms = 0.0, refine_ms = 0.0, paint_ms = 0.0;  ///< in the order of the work
  /// Of all stages [ms].
  double total() const { return select_ms + cluster_ms + refine_ms + paint_ms; }
};

/// The way of one scan: select, cluster, refine, paint. Not shared between threads.
class FramePipeline
{
public:
  /// Throws std::invalid_argument on a value outside its range, and without a clusterer.
  FramePipeline(std::shared_ptr<const ClassTable> table, const PipelineConfig& config,
                std::unique_ptr<Clusterer> clusterer);

  /// Exchanges everything but the memory of colours, for a change of parameters between two scans.
  void reconfigure(const PipelineConfig& config, std::unique_ptr<Clusterer> clusterer);

  /// Select, cluster, refine: finds the instances of a scan. Throws std::invalid_argument when the cloud's size
  /// contradicts its points, and when the clusterer needs scan lines and gets one row of points that is none;
  /// std::logic_error with its class's name when the clusterer breaks Clusterer's contract. Afterwards there are no
  /// things and no instances.
  void segment(const LabelledCloud& in);

  /// Fills `out` with the points of `in`, the cloud given to segment() last, in the same order, with instance ids and
  /// colours; header, width, height and coordinates are the same bit for bit. Labels change only where an instance's
  /// vote went against a point's class: to the canonical id of the instance's class. Throws std::invalid_argument on a
  /// cloud of another size.
  void paint(const LabelledCloud& in, PanopticCloud& out);

  /// Both, with one pass over the cloud for selection and copy: the same result, faster. The time of the copy counts as
  /// the selection's. Throws as segment() does; then `out` holds nothing of use.
  void process(const LabelledCloud& in, PanopticCloud& out);

  /// The instances' colours (0xRRGGBB, by id - 1), as paint() uses them; valid until the next segment().
  const std::vector<std::uint32_t>& colors();

  /// The class that the vote gives a point of instance `id` (1..n) and class `own`.
  ClassIndex votedClass(std::uint32_t id, ClassIndex own) const
  {
    return vote_ ? instances_.objects[id - 1].class_index : own;
  }

  /// Of the scan processed last.
  const ThingScan& things() const { return things_; }
  /// Of the scan processed last.
  const Instances& instances() const { return instances_; }
  /// Of the scan processed last.
  const StageTimes& times() const { return times_; }
  /// Of the labels.
  const ClassTable& table() const { return *table_; }

private:
  void segment(const LabelledCloud& in, PanopticCloud* out);
  void paintThings(PanopticCloud& out);

  std::shared_ptr<const ClassTable> table_;
  SelectionConfig selection_;
  Refinement refinement_;
  bool vote_;
  std::unique_ptr<Clusterer> clusterer_;
  InstanceColors colors_;
  bool colored_ = false;  ///< the scan in hand has its colours

  ThingScan things_;
  std::vector<std::uint32_t> component_;
  Instances instances_;
  StageTimes times_;
};
}  // namespace lidar_panoptic_clustering
