#pragma once

#include "lidar_panoptic_clustering/drawing/named_box.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/refinement/instance_boxes.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// A scan clustered for a picture.
struct FigureScan
{
  PanopticCloud cloud;
  std::vector<NamedBox> boxes;  ///< one an instance, with its class and id
};

/// The cloud as a network hands it on: without instances.
inline LabelledCloud withoutInstances(const PanopticCloud& cloud)
{
  LabelledCloud labelled(cloud.width, cloud.height, LabelledPoint());
  for (std::size_t i = 0; i < cloud.size(); ++i)
  {
    labelled.points[i].getVector3fMap() = cloud.points[i].getVector3fMap();
    labelled.points[i].label = cloud.points[i].label;
  }
  return labelled;
}

/// Clusters `cloud` by SemanticKITTI's class table. Boxes of fewer than `min_points` are left out. Throws as
/// makeAlgorithm does.
inline FigureScan clusterForFigure(const LabelledCloud& cloud, const std::string& algorithm,
                                   const ParameterMap& parameters, std::uint32_t min_points = 1)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  Algorithm made = makeAlgorithm(algorithm, parameters);
  FramePipeline pipeline(table, made.pipeline, std::move(made.clusterer));
  FigureScan scan;
  pipeline.segment(cloud);
  pipeline.paint(cloud, scan.cloud);

  std::vector<std::uint32_t> color(pipeline.instances().count());
  for (const PanopticPoint& point : scan.cloud)
    if (point.instance > 0) color[point.instance - 1] = point.rgb;
  InstanceBoxes fitter;
  const auto& boxes = fitter.fit(pipeline.things(), pipeline.instances());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    const Instances::Object& object = pipeline.instances().objects[i];
    if (object.point_count < min_points) continue;
    const InstanceBox& box = boxes[i];
    scan.boxes.push_back({box.x, box.y, box.z, box.length, box.width, box.height, box.yaw, color[i],
                          (*table)[object.class_index].name + " " + std::to_string(i + 1)});
  }
  return scan;
}

/// Gives every point on a thing its class's colour.
inline void colorByClass(PanopticCloud& cloud)
{
  static const ClassTable table = ClassTable::load("semantic_kitti");
  for (PanopticPoint& point : cloud) point.rgb = table.rgbOf(point.label);
}
}  // namespace lidar_panoptic_clustering
