#include "python/benchmark_parts.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;
namespace
{
/// Those of the data set that have classes to cluster by, and with `evaluate` ground truth to compare with.
std::vector<std::string> sequencesOf(const BenchmarkSettings& settings)
{
  std::vector<std::string> names;
  for (const std::string& name : semanticKittiSequences(settings.dataset))
  {
    const bool from_truth = settings.evaluate || settings.semantics.empty();
    if (from_truth ? SemanticKittiSequence(settings.dataset, name).hasLabels()
                   : fs::is_directory(fs::path(settings.semantics) / "sequences" / name / "predictions"))
      names.push_back(name);
  }
  if (!names.empty()) return names;
  throw std::runtime_error(settings.evaluate || settings.semantics.empty()
                               ? "no sequence of " + settings.dataset + " has a folder 'labels'"
                               : "no sequence of " + settings.dataset + " has classes in " + settings.semantics +
                                     "/sequences/SS/predictions");
}

BenchmarkSettings ofSequence(BenchmarkSettings settings, const std::string& sequence)
{
  settings.sequences = {sequence};
  return settings;
}
}  // namespace

BenchmarkPlan::BenchmarkPlan(const GivenOptions& options, bool label) : settings_(readBenchmarkOptions(options))
{
  settings_.quiet = true;
  settings_.evaluate = !label;
  settings_.row_folders = !label;
  if (label && settings_.rows.size() != 1)
    throw std::invalid_argument("predictions are of one algorithm with one setting, found " +
                                std::to_string(settings_.rows.size()));
  if (label && settings_.output.empty()) throw std::invalid_argument("--output is missing; see --help");
  table_ = std::make_shared<const ClassTable>(ClassTable::load(settings_.class_table));
  sequences_ = settings_.sequences.empty() ? sequencesOf(settings_) : settings_.sequences;
  std::set<std::string> seen;
  for (const std::string& name : sequences_)
    if (!seen.insert(name).second) throw std::invalid_argument("sequence " + name + " is given twice");
}

BenchmarkReport BenchmarkPlan::emptyReport() const
{
  std::vector<std::string> names;
  for (const RowSettings& row : settings_.rows) names.push_back(row.name);
  BenchmarkReport report(settings_.semantics.empty() ? "ground truth" : settings_.semantics, names, table_);
  for (BenchmarkRow& row : report.rows)
    if (settings_.track) row.evaluation.temporal.emplace(table_), row.evaluation.id_switches = 0;
  return report;
}

SequenceBenchmark::SequenceBenchmark(const BenchmarkPlan& plan, const std::string& sequence)
    : evaluate_(plan.settings().evaluate), run_(ofSequence(plan.settings(), sequence), plan.table())
{
}

std::vector<std::pair<std::string, std::string>> SequenceBenchmark::skipped() const
{
  std::vector<std::pair<std::string, std::string>> result;
  for (const SkippedScan& one : run_.scans().skipped()) result.emplace_back(one.scan, one.reason);
  return result;
}

SequenceBenchmark::Result SequenceBenchmark::run(std::size_t begin, std::size_t end)
{
  if (begin >= end || end > size())
    throw std::out_of_range("scans " + std::to_string(begin) + " to " + std::to_string(end) + " of " +
                            std::to_string(size()) + ": the data set is another one than where the run began");
  const std::size_t used = run_.used(), resumed = run_.resumed();
  BenchmarkReport report = run_.runPart(begin, end);
  Result result;
  for (const SkippedScan& one : report.before.skipped) result.skipped.emplace_back(one.scan, one.reason);
  result.used = run_.used() - used;
  result.resumed = run_.resumed() - resumed;
  report.before.skipped.clear();
  if (evaluate_) result.report = report.toJsonText();
  return result;
}

void BenchmarkSum::add(const std::string& report)
{
  levels_.push_back({1, BenchmarkReport::fromJsonText(report, "a worker's report", plan_.table())});
  while (levels_.size() > 1 && levels_[levels_.size() - 2].parts <= levels_.back().parts)
  {
    Level last = std::move(levels_.back());
    levels_.pop_back();
    levels_.back().report += last.report;
    levels_.back().parts += last.parts;
  }
}

BenchmarkReport BenchmarkSum::total(bool interrupted)
{
  while (levels_.size() > 1)
  {
    const Level last = std::move(levels_.back());
    levels_.pop_back();
    levels_.back().report += last.report;
    levels_.back().parts += last.parts;
  }
  BenchmarkReport report = levels_.empty() ? plan_.emptyReport() : levels_.front().report;
  std::sort(skipped_.begin(), skipped_.end(),
            [](const SkippedScan& a, const SkippedScan& b) { return a.scan < b.scan; });
  report.before.skipped = skipped_;
  for (BenchmarkRow& row : report.rows) row.evaluation.skipped = skipped_;
  report.interrupted = interrupted;
  return report;
}
}  // namespace lidar_panoptic_clustering
