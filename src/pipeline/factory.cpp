#include "lidar_panoptic_clustering/pipeline/factory.h"

#include "lidar_panoptic_clustering/clusterers/birds_eye_clusterer.h"
#include "lidar_panoptic_clustering/clusterers/depth_clusterer.h"
#include "lidar_panoptic_clustering/clusterers/euclidean_clusterer.h"
#include "lidar_panoptic_clustering/clusterers/scan_line_run_clusterer.h"
#include "lidar_panoptic_clustering/clusterers/supervoxel_clusterer.h"

#include <sstream>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
/// The pipeline's parameters and the algorithm's, side by side.
template <class ClustererConfig>
struct WholeConfig
{
  PipelineConfig pipeline;
  ClustererConfig clusterer;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    ClustererConfig::visit(self.clusterer, visitor);
    PipelineConfig::visit(self.pipeline, visitor);
  }
};

struct Entry
{
  std::string name;
  std::vector<ParameterInfo> (*describe)();
  Algorithm (*make)(const ParameterMap&);
};

template <class ClustererType>
Entry entry(const std::string& name)
{
  using Config = WholeConfig<typename ClustererType::Config>;
  return {name, [] { return describeParameters(Config{}); },
          [](const ParameterMap& parameters)
          {
            Config config;
            applyParameters(config, parameters);
            return Algorithm{config.pipeline, std::make_unique<ClustererType>(config.clusterer)};
          }};
}

/// One line an algorithm. cluster.launch, ./demo and the tests look for the nodelet MyRuleClusterNodelet of "my_rule".
const std::vector<Entry>& entries()
{
  static const std::vector<Entry> list = {
      entry<EuclideanClusterer>("euclidean"),        //
      entry<SupervoxelClusterer>("supervoxel"),      //
      entry<DepthClusterer>("depth"),                //
      entry<ScanLineRunClusterer>("scan_line_run"),  //
      entry<BirdsEyeClusterer>("birds_eye"),         //
  };
  return list;
}

const Entry& find(const std::string& algorithm)
{
  std::string known;
  for (const auto& entry : entries())
  {
    if (entry.name == algorithm) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("there is no algorithm '" + algorithm + "'; there are: " + known);
}
}  // namespace

std::vector<std::string> algorithmNames()
{
  std::vector<std::string> names;
  for (const auto& entry : entries()) names.push_back(entry.name);
  return names;
}

std::vector<std::string> algorithmsOfList(const std::string& list)
{
  if (list == "all") return algorithmNames();
  std::vector<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');) names.push_back(find(name).name);
  if (names.empty()) find(list);
  return names;
}

std::vector<ParameterInfo> algorithmParameters(const std::string& algorithm)
{
  return find(algorithm).describe();
}

ParameterMap surveyParameters(const std::string& algorithm)
{
  ParameterMap parameters = {
      {"link_distance_scale", 100.0}, {"bridge_distance_m", 0.0}, {"split", false}, {"merge", false}, {"vote", false}};
  if (algorithm == "euclidean" || algorithm == "birds_eye") parameters["distance_m"] = 0.5;
  return parameters;
}

Algorithm makeAlgorithm(const std::string& algorithm, const ParameterMap& parameters)
{
  return find(algorithm).make(parameters);
}
}  // namespace lidar_panoptic_clustering
