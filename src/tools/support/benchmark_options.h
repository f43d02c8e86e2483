#pragma once

#include "core/plain_numbers.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "tools/support/benchmark_settings.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
enum class OptionKind
{
  kFlag,
  kText,
  kList,  ///< one or more texts, which may be given in several places
  kNumber
};

struct BenchmarkOption
{
  const char* name;
  OptionKind kind;
  const char* value;  ///< what stands for it in the help
  const char* text;   ///< of the help
  int number = 0;     ///< where it is not given
};

/// What a benchmark runs on and with: the options of panoptic_benchmark and of its Python counterpart on a cluster.
constexpr BenchmarkOption kBenchmarkOptions[] = {
    {"dataset", OptionKind::kText, "DIR", "folder that holds sequences/SS/{velodyne,labels}"},
    {"sequences", OptionKind::kText, "00,05", "sequences to run on; otherwise all of the data set with labels"},
    {"split", OptionKind::kText, "NAME", "train, valid (sequence 08) or test instead of --sequences"},
    {"semantics", OptionKind::kText, "DIR",
     "folder that holds sequences/SS/predictions, a network's classes; otherwise the ground truth's"},
    {"algorithms", OptionKind::kText, "A,B",
     "algorithms to run; otherwise all (supervoxel twice, without and with normals)"},
    {"survey", OptionKind::kFlag, "", "the settings of Zhao et al. 2021: no class sizes, no refinement"},
    {"set", OptionKind::kList, "A.P=V,V ..",
     "sets parameter P of algorithm A; several values, or several parameters, give a row each"},
    {"switches", OptionKind::kFlag, "",
     "also each row with no step of the refinement, with each alone, and with all but each"},
    {"track", OptionKind::kFlag, "",
     "ids that stay with an object from scan to scan, by the data set's poses; adds LSTQ, S_assoc, S_cls and id "
     "switches to each row"},
    {"limit", OptionKind::kNumber, "N", "the first N scans of each sequence; 0: all"},
    {"output", OptionKind::kText, "DIR",
     "write ROW/sequences/SS/predictions/NNNNNN.label; a later run goes on where this one stops"},
    {"class-table", OptionKind::kText, "FILE",
     "YAML file, or the name of a table that ships with the package (default: semantic_kitti)"},
    {"label-table", OptionKind::kText, "FILE",
     "what the class ids of --semantics mean, e.g. semantic_kitti_training (default: the class table)"},
    {"columns", OptionKind::kNumber, "N", "of the range image", 2048},
    {"keep-going", OptionKind::kFlag, "", "skip scans that cannot be used and count them in the report"}};

/// Values by the option's name; of a flag none.
using GivenOptions = std::map<std::string, std::vector<std::string>>;

namespace detail
{
inline bool hasOption(const GivenOptions& given, const std::string& option)
{
  return given.count(option) != 0;
}

inline std::vector<std::string> valuesOf(const GivenOptions& given, const std::string& option)
{
  const auto found = given.find(option);
  return found == given.end() ? std::vector<std::string>{} : found->second;
}

/// "" where it is not given.
inline std::string valueOf(const GivenOptions& given, const std::string& option)
{
  const std::vector<std::string> values = valuesOf(given, option);
  return values.empty() ? "" : values.back();
}

inline int numberOf(const GivenOptions& given, const std::string& option, int min, int max)
{
  const auto* known = std::find_if(std::begin(kBenchmarkOptions), std::end(kBenchmarkOptions),
                                   [&](const BenchmarkOption& one) { return option == one.name; });
  if (!hasOption(given, option)) return known->number;
  const std::string text = valueOf(given, option);
  const std::optional<double> value = parseNumber(text);
  if (!value || std::floor(*value) != *value || *value < min || *value > max)
    throw std::invalid_argument("--" + option + " is " + text + ", expected " + std::to_string(min) + " to " +
                                std::to_string(max));
  return static_cast<int>(*value);
}
}  // namespace detail

/// Throws std::invalid_argument naming the option.
inline BenchmarkSettings readBenchmarkOptions(const GivenOptions& given)
{
  using namespace detail;
  BenchmarkSettings settings;
  settings.dataset = valueOf(given, "dataset");
  if (settings.dataset.empty()) throw std::invalid_argument("--dataset is missing; see --help");
  if (hasOption(given, "sequences") && hasOption(given, "split"))
    throw std::invalid_argument("--sequences and --split exclude each other");
  if (hasOption(given, "sequences")) settings.sequences = splitAtCommas(valueOf(given, "sequences"), "--sequences");
  if (hasOption(given, "split")) settings.sequences = semanticKittiSplit(valueOf(given, "split"));
  settings.semantics = std::filesystem::path(valueOf(given, "semantics")).lexically_normal().string();
  if (hasOption(given, "class-table")) settings.class_table = valueOf(given, "class-table");
  settings.label_table = valueOf(given, "label-table");
  if (!settings.label_table.empty() && settings.semantics.empty())
    throw std::invalid_argument("--label-table says what the ids of --semantics mean, which is not given");
  std::vector<std::string> algorithms;
  if (hasOption(given, "algorithms")) algorithms = splitAtCommas(valueOf(given, "algorithms"), "--algorithms");
  if (hasOption(given, "switches") && hasOption(given, "survey"))
    throw std::invalid_argument("--switches and --survey exclude each other: the survey has no refinement");
  settings.rows =
      makeRows(algorithms, valuesOf(given, "set"), hasOption(given, "survey"), hasOption(given, "switches"));
  settings.output = valueOf(given, "output");
  settings.limit = numberOf(given, "limit", 0, 1 << 30);
  settings.columns = numberOf(given, "columns", 16, 16384);
  settings.keep_going = hasOption(given, "keep-going");
  settings.track = hasOption(given, "track");
  return settings;
}
}  // namespace lidar_panoptic_clustering
