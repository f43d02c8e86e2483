#pragma once

#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "tools/support/program.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// One algorithm with one setting: a row of the benchmark's tables.
struct RowSettings
{
  std::string name;  ///< "depth", or with what was set "depth theta_deg=5"
  std::string algorithm;
  ParameterMap parameters;  ///< text, as given
  bool survey = false;      ///< on top of surveyParameters() instead of the defaults
  std::string steps{};      ///< which steps of the refinement are on, for the name; empty: as the parameters say

  ParameterMap allParameters() const
  {
    ParameterMap all = parameters;
    if (survey) all.merge(surveyParameters(algorithm));
    return all;
  }
};

struct BenchmarkSettings
{
  std::string dataset;                 ///< folder that holds `sequences`
  std::vector<std::string> sequences;  ///< "00", ..; none: all of the data set that have ground truth
  std::string semantics;               ///< folder of predicted classes; empty: the true ones
  std::string class_table = "semantic_kitti";
  std::string label_table;  ///< of the predicted classes; empty: the class table
  std::vector<RowSettings> rows;
  std::string output;  ///< folder of the predictions; empty: none are written
  int jobs = 1;
  int shard = 1, shards = 1;  ///< every shards-th scan, beginning with the shard-th
  int limit = 0;              ///< the first scans of each sequence; 0: all
  int columns = 2048;         ///< of the range image
  bool keep_going = false;    ///< skip and count scans that cannot be used
  bool track = false;         ///< ids that stay with an object from scan to scan
  bool evaluate = true;       ///< by the ground truth, where there is one
  bool row_folders = true;    ///< a folder a row in `output`; else there is one row, and `output` is its folder
  bool quiet = false;         ///< nothing is printed on the way
};

/// `--set algorithm.parameter=value,value`
struct ParameterSweep
{
  std::string algorithm, parameter;
  std::vector<std::string> values;
};

/// Throws std::invalid_argument when the text is not of that form.
inline ParameterSweep parseSweep(const std::string& text)
{
  const std::size_t dot = text.find('.'), equals = text.find('=');
  if (dot == std::string::npos || equals == std::string::npos || dot == 0 || equals < dot + 2)
    throw std::invalid_argument("--set " + text + ": expected algorithm.parameter=value[,value..]");
  return {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1),
          splitAtCommas(text.substr(equals + 1), "--set " + text.substr(0, equals))};
}

/// All algorithms, and for supervoxel a second row with normals, as the survey has them.
inline std::vector<RowSettings> allRows()
{
  std::vector<RowSettings> rows;
  for (const std::string& name : algorithmNames())
  {
    rows.push_back({name, name, {}, false});
    if (name == "supervoxel")
      rows.push_back({name + " normal_weight=0.5", name, {{"normal_weight", std::string("0.5")}}, false});
  }
  return rows;
}

/// Makes of each row of the algorithm one a value.
inline std::vector<RowSettings> applySweep(const std::vector<RowSettings>& rows, const ParameterSweep& sweep)
{
  std::vector<RowSettings> result;
  bool found = false;
  for (const RowSettings& row : rows)
  {
    if (row.algorithm != sweep.algorithm)
    {
      result.push_back(row);
      continue;
    }
    found = true;
    for (const std::string& value : sweep.values)
    {
      result.push_back(row);
      result.back().parameters[sweep.parameter] = value;
    }
  }
  if (!found)
    throw std::invalid_argument("--set " + sweep.algorithm + "." + sweep.parameter + ": no row runs algorithm '" +
                                sweep.algorithm + "'");
  return result;
}

/// A step of the refinement, and what switches it off.
struct RefinementSwitch
{
  const char *step, *parameter, *off;
};
constexpr RefinementSwitch kRefinementSwitches[] = {{"bridge", "bridge_distance_m", "0"},
                                                    {"split", "split", "false"},
                                                    {"merge", "merge", "false"},
                                                    {"vote", "vote", "false"}};

/// The row itself, and with no step of the refinement, with each step alone, and with all but each step. Throws
/// std::invalid_argument when the row sets a step already.
inline std::vector<RowSettings> switchRows(const RowSettings& row)
{
  for (const RefinementSwitch& s : kRefinementSwitches)
    if (row.parameters.count(s.parameter) != 0)
      throw std::invalid_argument("--switches sets " + std::string(s.parameter) + " itself, found --set " +
                                  row.algorithm + "." + s.parameter);
  const auto with = [&row](const std::string& steps, const auto& isOff)
  {
    RowSettings variant = row;
    variant.steps = steps;
    for (const RefinementSwitch& s : kRefinementSwitches)
      if (isOff(s)) variant.parameters[s.parameter] = std::string(s.off);
    return variant;
  };
  std::vector<RowSettings> rows = {row, with("no step", [](const auto&) { return true; })};
  for (const RefinementSwitch& s : kRefinementSwitches)
    rows.push_back(with(std::string("only ") + s.step, [&s](const auto& other) { return other.step != s.step; }));
  for (const RefinementSwitch& s : kRefinementSwitches)
    rows.push_back(with(std::string("all but ") + s.step, [&s](const auto& other) { return other.step == s.step; }));
  return rows;
}

/// Names the row by what is set, and drops rows that a sweep made equal to one before.
inline std::vector<RowSettings> nameRows(std::vector<RowSettings> rows)
{
  std::vector<RowSettings> result;
  for (RowSettings& row : rows)
  {
    row.name = row.algorithm + (row.survey ? " survey" : "");
    const auto is_switch = [&row](const std::string& parameter)
    {
      return !row.steps.empty() && std::any_of(std::begin(kRefinementSwitches), std::end(kRefinementSwitches),
                                               [&](const auto& s) { return parameter == s.parameter; });
    };
    for (const auto& [parameter, value] : row.parameters)
      if (!is_switch(parameter)) row.name += " " + parameter + "=" + std::get<std::string>(value);
    if (!row.steps.empty()) row.name += ", " + row.steps;
    const auto same = [&](const RowSettings& other) { return other.name == row.name; };
    if (std::none_of(result.begin(), result.end(), same)) result.push_back(std::move(row));
  }
  return result;
}

/// The rows of `--algorithms` (none: all), with the survey's settings or the defaults, and all `--set`, several of one
/// algorithm combined; with `switches`, each as switchRows() has it. Throws std::invalid_argument on unknown
/// algorithms, parameters and values out of range, with what there is.
inline std::vector<RowSettings> makeRows(const std::vector<std::string>& algorithms,
                                         const std::vector<std::string>& sets, bool survey = false,
                                         bool switches = false)
{
  std::vector<RowSettings> rows = algorithms.empty() ? allRows() : std::vector<RowSettings>{};
  for (const std::string& name : algorithms) rows.push_back({name, name, {}, false});
  for (RowSettings& row : rows) makeAlgorithm(row.algorithm), row.survey = survey;
  for (const std::string& text : sets) rows = applySweep(rows, parseSweep(text));
  if (switches)
  {
    std::vector<RowSettings> all;
    for (const RowSettings& row : rows)
      for (RowSettings& variant : switchRows(row)) all.push_back(std::move(variant));
    rows = std::move(all);
  }
  for (const RowSettings& row : rows)
  {
    try
    {
      makeAlgorithm(row.algorithm, row.allParameters());
    }
    catch (const std::invalid_argument& error)
    {
      throw std::invalid_argument("algorithm '" + row.algorithm + "': " + error.what());
    }
  }
  return nameRows(std::move(rows));
}
}  // namespace lidar_panoptic_clustering
