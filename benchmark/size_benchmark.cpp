// Cost of the whole way of a scan against the number of its things, 1,000 to 1,000,000: sensors from 8 rings x 128
// columns to 256 x 4096 in the simulated street, with its true classes and with every return a thing. Prints a table;
// draws a chart where a path of a PNG is given.
#include "measure.h"

#include "lidar_panoptic_clustering/drawing/chart.h"

#include <cmath>
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
LineChart::Series measureSizes(const std::string& algorithm, const std::string& kind, const std::string& what)
{
  LineChart::Series series;
  series.name = algorithm + ", " + what;
  for (const std::string rings : {"8", "16", "32", "64", "128", "256"})
  {
    const Scans& scans = scene(kind + rings);
    const double things = meanThings(scans), copy = leastCopy();
    const double seconds = leastSeconds(scans, algorithm);
    series.points.push_back({things, seconds / copy});
    std::printf("%-14s %-18s %6s rings %9.0f things %9.3f ms %9.2f copies %8.1f ns a thing\n", algorithm.c_str(),
                what.c_str(), rings.c_str(), things, 1e3 * seconds, seconds / copy, 1e9 * seconds / things);
    std::fflush(stdout);
  }
  return series;
}

/// What grows as n log n, through the first point of a series.
LineChart::Series guide(const LineChart::Series& series)
{
  LineChart::Series line;
  line.name = "n log n";
  line.markers = false;
  const LineChart::Point first = series.points[1];
  for (double things = first.x; things < 1.2e6; things *= 2.0)
    line.points.push_back({things, first.y * things * std::log(things) / (first.x * std::log(first.x))});
  return line;
}

void run(const std::string& path)
{
  LineChart chart;
  chart.frame.title = "Cost of a scan against its size";
  chart.frame.subtitle = "whole way, one thread, simulated street, 8 x 128 to 256 x 4096";
  chart.x = {"things", true};
  chart.y = {"copies of a 64 x 2048 cloud", true};
  for (const std::string algorithm : {"depth", "scan_line_run", "birds_eye", "euclidean"})
    chart.series.push_back(measureSizes(algorithm, "size/", "true classes"));
  for (const std::string algorithm : {"depth", "scan_line_run", "birds_eye"})
    chart.series.push_back(measureSizes(algorithm, "size_all_things/", "every return"));
  chart.series.push_back(guide(chart.series.back()));
  if (!path.empty()) drawChart(chart, path);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
try
{
  lidar_panoptic_clustering::run(argc > 1 ? argv[1] : "");
  return 0;
}
catch (const std::exception& error)
{
  std::cerr << "size_benchmark: " << error.what() << '\n';
  return 1;
}
