// Labels without a network, and the whole way from a driver's cloud to objects without one, in copies of the labelled
// 64 x 2048 cloud.
#include "measure.h"

#include "lidar_panoptic_clustering/labelling/ground_labeler.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"

namespace lidar_panoptic_clustering
{
namespace
{
void label(benchmark::State& state, Scans scans)
{
  GroundLabeler labeler{GroundLabelerConfig{}};
  measure(state, [&](std::size_t i) { labeler.label(scans[i % scans.size()]); });
}

/// From a cloud as Velodyne's driver organises it: rows are firings.
void toObjects(benchmark::State& state, const Scans& scans)
{
  ScanToObjectsConfig config;
  config.labeller.labels = "none";
  ScanToObjects chain(config);
  std::vector<RawMessage> messages;
  for (const auto& scan : scans) messages.push_back(transposed(organisedMessage(scan)));
  measure(state, [&](std::size_t i) { chain.process(messages[i % messages.size()].view()); });
}

void addAll()
{
  for (const std::string name : {"street", "recorded"})
  {
    addOn(name + "/label", name, [](benchmark::State& state, const Scans& scans) { label(state, scans); });
    addOn(name + "/driver_to_objects", name, toObjects);
  }
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}
