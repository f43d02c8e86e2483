#pragma once

#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "lidar_panoptic_clustering/projection/original_labeller.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_labeller.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What ScanToObjects does with a cloud.
struct ScanToObjectsConfig
{
  OrganizerConfig organizer;            ///< how the points lie in the cloud; `labels` follows from the labeller's
  ScanLabellerConfig labeller;          ///< where the classes come from
  std::string algorithm = "birds_eye";  ///< see algorithmNames()
  ParameterMap parameters{};            ///< of the algorithm and what surrounds it, see algorithmParameters()
};

/// From a cloud as a driver sends it to objects, in one call: what OrganizerNodelet and a cluster nodelet do together.
///
/// layout (Organizer) -> classes (ScanLabeller) -> select, cluster, refine, paint (FramePipeline) -> boxes
/// (InstanceBoxes) -> back to the points as sent (OriginalLabeller). Buffers are kept between scans; not shared between
/// threads. Linear in points and pixels, but for what the algorithm takes.
class ScanToObjects
{
public:
  /// Throws std::invalid_argument or std::runtime_error, as the parts do, on parameters and files that cannot be used.
  explicit ScanToObjects(const ScanToObjectsConfig& config);

  /// `cloud` carries its classes, or they come from the geometry, as `labeller.labels` says ("field" or "none").
  /// Throws std::invalid_argument, with what was expected and found, when the cloud or its labels cannot be used; what
  /// the functions below return is then undefined until a scan goes through.
  void process(const RawCloud& cloud);
  /// The same with the classes in a second cloud that has the points of `cloud` ("cloud").
  void process(const RawCloud& cloud, const RawCloud& labels);
  /// The same with the classes in a picture of the range image ("image").
  void process(const RawCloud& cloud, const RawImage& labels);

  /// Of the scan processed last, a raw class id of classTable() and an instance (1..n, 0 for none) a point, in the
  /// order sent, row-major; points that the range image hides included.
  const std::vector<std::uint32_t>& labels() const { return label_; }
  /// Parallel to labels().
  const std::vector<std::uint32_t>& instanceIds() const { return instance_; }

  /// The objects of the scan's image and a box each, by id - 1. Instances beyond their number in instanceIds() are
  /// objects that only hidden points show.
  const Instances& instances() const { return pipeline_.instances(); }
  /// Parallel to instances().objects; sensor frame.
  const std::vector<InstanceBox>& boxes() const { return *boxes_; }

  /// The organised scan (its points' classes are those of labels(), not its own) and the painted image, with
  /// `kNone`-owned pixels as NaN; milliseconds a stage.
  const OrganizedScan& scan() const { return scan_; }
  /// The painted image; pixels that no point owns are NaN.
  const PanopticCloud& image() const { return image_; }
  /// Milliseconds of the scan processed last, from select to paint.
  const StageTimes& times() const { return pipeline_.times(); }

  /// Of the labels that go out.
  const ClassTable& classTable() const { return *labeller_.classTable(); }

private:
  ScanToObjects(const ScanToObjectsConfig& config, Algorithm algorithm);
  void require(const char* expected) const;
  void find();

  std::string labels_, label_field_;
  Organizer organizer_;
  ScanLabeller labeller_;
  FramePipeline pipeline_;
  InstanceBoxes box_fitter_;
  OriginalLabeller original_labeller_;

  OrganizedScan scan_;
  PanopticCloud image_;
  const std::vector<InstanceBox>* boxes_;
  std::vector<std::uint32_t> label_, instance_;
};

/// A KITTI scan as a cloud of one row: a view of `points`, x y z intensity float32.
RawCloud viewOf(const std::vector<ScanPoint>& points);
}  // namespace lidar_panoptic_clustering
