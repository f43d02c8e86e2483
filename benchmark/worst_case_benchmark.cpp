// Scans built to cost the most, 64 x 2048 with a thing in every pixel; all_things/ in pipeline_benchmark are usual
// scans with as many points.
#include "measure.h"

namespace lidar_panoptic_clustering
{
namespace
{
void addAll()
{
  for (const auto& worst : worstScans()) addAlgorithms("worst/" + worst.name, {"depth", "scan_line_run", "birds_eye"});
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runBenchmarks(argc, argv, addAll);
}
