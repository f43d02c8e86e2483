#pragma once

#include "lidar_panoptic_clustering/core/clusterer.h"
#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"

#include <memory>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// The algorithms' names: "euclidean", "supervoxel", "depth", "scan_line_run", "birds_eye".
std::vector<std::string> algorithmNames();

/// The algorithms of a list with commas, in its order: "depth,birds_eye"; "all" stands for all of them.
/// Throws std::invalid_argument on an unknown name and on an empty list; the message lists what there is.
std::vector<std::string> algorithmsOfList(const std::string& list);

/// The parameters of an algorithm and of the pipeline around it, with defaults and ranges.
/// Throws std::invalid_argument on an unknown name.
std::vector<ParameterInfo> algorithmParameters(const std::string& algorithm);

/// What makes an algorithm the one of Zhao et al. 2021: no class sizes, no refinement. Any name is taken.
ParameterMap surveyParameters(const std::string& algorithm);

/// What FramePipeline needs: the configuration around the clusterer, and the clusterer.
struct Algorithm
{
  PipelineConfig pipeline;
  std::unique_ptr<Clusterer> clusterer;
};

/// An algorithm by name, its defaults overridden by `parameters`. Throws std::invalid_argument on an unknown algorithm
/// or parameter, and on a value outside its range; the message lists what there is.
Algorithm makeAlgorithm(const std::string& algorithm, const ParameterMap& parameters = {});
}  // namespace lidar_panoptic_clustering
