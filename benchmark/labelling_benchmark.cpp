// Labels without a network beside a plain copy of the scan: recorded SemanticKITTI scans where there are some, and
// simulated ones.
#include "benchmark_scans.h"

#include "lidar_panoptic_clustering/labelling/ground_labeler.h"

namespace lidar_panoptic_clustering
{
namespace
{
void label(benchmark::State& state, Scans scans)
{
  GroundLabeler labeler{GroundLabelerConfig{}};
  std::size_t i = 0;
  for (auto _ : state) labeler.label(scans[i++ % scans.size()]);
}

std::unique_ptr<const std::pair<Scans, Scans>> addAll()
{
  auto kept = std::make_unique<const std::pair<Scans, Scans>>(simulatedScans(SensorModel::load("hdl64e"), 10, 60),
                                                              recordedScans());
  const auto addScans = [](const std::string& source, const Scans& scans)
  {
    if (scans.empty()) return;
    add(source + "/plain_copy", [&scans](benchmark::State& state) { plainCopy(state, scans); });
    add(source + "/label", [&scans](benchmark::State& state) { label(state, scans); });
  };
  addScans("simulated", kept->first);
  addScans("recorded", kept->second);
  return kept;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}
