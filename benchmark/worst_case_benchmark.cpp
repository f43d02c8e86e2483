// Scans built to cost the most, 64 x 2048 with a thing in every pixel, beside a usual scan with as many points.
#include "benchmark_scans.h"
#include "worst_scans.h"

namespace lidar_panoptic_clustering
{
namespace
{
using Builds = std::vector<std::pair<std::string, Scans>>;

std::unique_ptr<Builds> addAll()
{
  auto builds = std::make_unique<Builds>();
  const Scans recorded = recordedScans();
  builds->emplace_back("usual",
                       allThings(recorded.empty() ? simulatedScans(SensorModel::load("hdl64e"), 10) : recorded));
  for (const auto& worst : worstScans()) builds->emplace_back(worst.name, Scans{worst.build(64, 2048)});
  for (const std::string name : {"depth", "scan_line_run", "birds_eye"})
    for (const auto& [build, scans] : *builds)
    {
      const Scans& each = scans;
      add("cluster/" + name + "/" + build, [&each, name](benchmark::State& state) { cluster(state, each, name); });
      add("pipeline/" + name + "/" + build, [&each, name](benchmark::State& state) { pipeline(state, each, name); });
    }
  return builds;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}
