#pragma once

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "tools/support/benchmark_settings.h"
#include "tools/support/program.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What a benchmark runs on and with: the options of panoptic_benchmark and of its Python counterpart on a cluster.
inline void addBenchmarkOptions(Options& options)
{
  options.add_options()("dataset", textValue("DIR"), "folder that holds sequences/SS/{velodyne,labels}");
  options.add_options()("sequences", textValue("00,05"),
                        "sequences to run on; otherwise all of the data set with labels");
  options.add_options()("split", textValue("NAME"), "train, valid (sequence 08) or test instead of --sequences");
  options.add_options()(
      "semantics", textValue("DIR"),
      "folder that holds sequences/SS/predictions, a network's classes; otherwise the ground truth's");
  options.add_options()("algorithms", textValue("A,B"),
                        "algorithms to run; otherwise all (supervoxel twice, without and with normals)");
  options.add_options()("survey", "the settings of Zhao et al. 2021: no class sizes, no refinement");
  options.add_options()("set", textValues("A.P=V,V ..")->composing(),
                        "sets parameter P of algorithm A; several values, or several parameters, give a row each");
  options.add_options()("switches",
                        "also each row with no step of the refinement, with each alone, and with all but each");
  options.add_options()("track",
                        "ids that stay with an object from scan to scan, by the data set's poses; adds LSTQ, S_assoc, "
                        "S_cls and id switches to each row");
  options.add_options()("limit", numberValue(0), "the first N scans of each sequence; 0: all");
  options.add_options()("output", textValue("DIR"),
                        "write ROW/sequences/SS/predictions/NNNNNN.label; a later run goes on where this one stops");
  options.add_options()("class-table", textValue("FILE"),
                        "YAML file, or the name of a table that ships with the package (default: semantic_kitti)");
  options.add_options()(
      "label-table", textValue("FILE"),
      "what the class ids of --semantics mean, e.g. semantic_kitti_training (default: the class table)");
  options.add_options()("columns", numberValue(2048), "of the range image");
  options.add_options()("keep-going", "skip scans that cannot be used and count them in the report");
}

/// Throws std::invalid_argument naming the option.
inline BenchmarkSettings readBenchmarkOptions(const Given& given)
{
  BenchmarkSettings settings;
  settings.dataset = textOf(given, "dataset");
  if (settings.dataset.empty()) throw std::invalid_argument("--dataset is missing; see --help");
  if (isGiven(given, "sequences") && isGiven(given, "split"))
    throw std::invalid_argument("--sequences and --split exclude each other");
  if (isGiven(given, "sequences")) settings.sequences = splitAtCommas(textOf(given, "sequences"), "--sequences");
  if (isGiven(given, "split")) settings.sequences = semanticKittiSplit(textOf(given, "split"));
  settings.semantics = std::filesystem::path(textOf(given, "semantics")).lexically_normal().string();
  if (isGiven(given, "class-table")) settings.class_table = textOf(given, "class-table");
  settings.label_table = textOf(given, "label-table");
  if (!settings.label_table.empty() && settings.semantics.empty())
    throw std::invalid_argument("--label-table says what the ids of --semantics mean, which is not given");
  std::vector<std::string> algorithms;
  if (isGiven(given, "algorithms")) algorithms = splitAtCommas(textOf(given, "algorithms"), "--algorithms");
  if (isGiven(given, "switches") && isGiven(given, "survey"))
    throw std::invalid_argument("--switches and --survey exclude each other: the survey has no refinement");
  settings.rows = makeRows(algorithms, listOf(given, "set"), isGiven(given, "survey"), isGiven(given, "switches"));
  settings.output = textOf(given, "output");
  settings.limit = numberOf(given, "limit", 0, 1 << 30);
  settings.columns = numberOf(given, "columns", 16, 16384);
  settings.keep_going = isGiven(given, "keep-going");
  settings.track = isGiven(given, "track");
  return settings;
}
}  // namespace lidar_panoptic_clustering
