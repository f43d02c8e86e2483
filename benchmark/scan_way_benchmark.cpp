// What projection, clustering and hidden points of panoptic_benchmark cost together: the measure that a call from
// Python is held to, see benchmark/python_calls.py. Prints one line an algorithm: its name and the milliseconds of CPU
// time of each scan, the least of the repetitions.
//
//   scan_way_benchmark DATASET SEQUENCE SCANS REPETITIONS
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/projection/hidden_points.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

using namespace lidar_panoptic_clustering;

namespace
{
double threadMilliseconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Scan
{
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> labels;
};

std::vector<Scan> readScans(const SemanticKittiSequence& sequence, std::size_t count)
{
  std::vector<Scan> scans(std::min(count, sequence.size()));
  for (std::size_t i = 0; i < scans.size(); ++i)
  {
    sequence.readScan(i, scans[i].points);
    sequence.readLabels(i, scans[i].points.size(), scans[i].labels);
    for (std::uint32_t& label : scans[i].labels) label = rawClass(label);
  }
  return scans;
}

/// The least time of each scan [ms].
std::vector<double> measure(const std::string& name, const std::vector<Scan>& scans, int repetitions)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  Algorithm algorithm = makeAlgorithm(name);
  FramePipeline pipeline(table, algorithm.pipeline, std::move(algorithm.clusterer));
  PointProjector projector{ProjectionConfig()};
  HiddenPointLabeller hidden_points(table);
  Projection projection;
  std::vector<std::uint32_t> of_pixel, of_point;
  std::vector<double> least(scans.size(), std::numeric_limits<double>::infinity());
  for (int k = 0; k <= repetitions; ++k)  // the first one warms up
    for (std::size_t i = 0; i < scans.size(); ++i)
    {
      const double start = threadMilliseconds();
      projector.project(scans[i].points, scans[i].labels, projection);
      pipeline.segment(projection.cloud);
      pixelInstances(pipeline.things(), pipeline.instances(), of_pixel);
      hidden_points.label(scans[i].points, scans[i].labels, projection, of_pixel, of_point);
      if (k > 0) least[i] = std::min(least[i], threadMilliseconds() - start);
    }
  return least;
}
}  // namespace

int main(int argc, char** argv)
{
  if (argc != 5)
  {
    std::fprintf(stderr, "usage: scan_way_benchmark DATASET SEQUENCE SCANS REPETITIONS\n");
    return EXIT_FAILURE;
  }
  const SemanticKittiSequence sequence(argv[1], argv[2]);
  const std::vector<Scan> scans = readScans(sequence, static_cast<std::size_t>(std::atoi(argv[3])));
  for (const std::string& name : algorithmNames())
  {
    std::printf("%s", name.c_str());
    for (const double ms : measure(name, scans, std::atoi(argv[4]))) std::printf(" %.4f", ms);
    std::printf("\n");
  }
  return EXIT_SUCCESS;
}
