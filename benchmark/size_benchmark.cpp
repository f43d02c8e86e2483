// Cost of the whole way of a scan against the number of its things, 1,000 to 1,000,000: sensors from 8 rings x 128
// columns to 256 x 4096 in the simulated street, with its true classes and with every return a thing. Prints a table
// with commas; size_chart.py draws it.
#include "measure.h"

#include <cstdio>
#include <exception>
#include <iostream>

namespace lidar_panoptic_clustering
{
namespace
{
/// Least CPU time of the whole way [s], over repetitions of a second at the most.
double leastSeconds(const Scans& scans, const std::string& algorithm)
{
  constexpr double kEnough = 1.0;
  constexpr std::size_t kMost = 40;
  Algorithm made = makeAlgorithm(algorithm);
  FramePipeline frames(kittiTable(), made.pipeline, std::move(made.clusterer));
  PanopticCloud out;
  double least = 1e9;
  const double start = cpuSeconds();
  for (std::size_t i = 0; i < kMost * scans.size() && (i < 4 || cpuSeconds() - start < kEnough); ++i)
  {
    const double begin = cpuSeconds();
    frames.process(scans[i % scans.size()], out);
    least = std::min(least, cpuSeconds() - begin);
  }
  return least;
}

double meanThings(const Scans& scans)
{
  double things = 0.0;
  for (const auto& scan : scans) things += static_cast<double>(thingsOf(scan).size());
  return things / static_cast<double>(scans.size());
}

double leastCopy()
{
  std::vector<double> times;
  PlainCopy::shared().run(times);
  return *std::min_element(times.begin(), times.end());
}

/// One line of the chart: an algorithm on scenes of one kind, from small to large.
void measureSizes(const std::string& algorithm, const std::string& kind, const std::string& what)
{
  for (const std::string rings : {"8", "16", "32", "64", "128", "256"})
  {
    const std::string name = kind + rings;
    const Scans& scans = scene(name);
    const double things = meanThings(scans), copy = leastCopy();
    const double seconds = leastSeconds(scans, algorithm);
    std::printf("%s,%s,%s,%.0f,%.3f,%.2f\n", algorithm.c_str(), what.c_str(), rings.c_str(), things, 1e3 * seconds,
                seconds / copy);
    std::fflush(stdout);
  }
}

void run()
{
  std::puts("algorithm,classes,rings,things,milliseconds,copies");
  for (const std::string algorithm : {"depth", "scan_line_run", "birds_eye", "euclidean"})
    measureSizes(algorithm, "size/", "true classes");
  for (const std::string algorithm : {"depth", "scan_line_run", "birds_eye"})
    measureSizes(algorithm, "size_all_things/", "every return");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main()
try
{
  lidar_panoptic_clustering::run();
  return 0;
}
catch (const std::exception& error)
{
  std::cerr << "size_benchmark: " << error.what() << '\n';
  return 1;
}
