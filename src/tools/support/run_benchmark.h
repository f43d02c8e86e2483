#pragma once

#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"
#include "tools/support/benchmark_output.h"
#include "tools/support/benchmark_scans.h"
#include "tools/support/benchmark_settings.h"
#include "tools/support/fingerprint.h"
#include "tools/support/interrupt.h"
#include "tools/support/label_tracker.h"
#include "tools/support/progress.h"
#include "tools/support/run_threads.h"
#include "tools/support/scan_clusterer.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Runs all rows on all scans: each scan is read and projected once, by one of `jobs` threads. When objects are
/// tracked, a thread takes whole sequences, scan after scan.
class BenchmarkRun
{
public:
  /// Throws as BenchmarkScans and RowOutput do, before any scan is read.
  BenchmarkRun(const BenchmarkSettings& settings, std::shared_ptr<const ClassTable> table)
      : settings_(settings), table_(std::move(table)), scans_(settings_, table_), report_(emptyReport())
  {
    if (!settings_.output.empty())
      for (const RowSettings& row : settings_.rows)
        outputs_.push_back(std::make_unique<RowOutput>(settings_, row, *table_));
    times_.assign(settings_.rows.size(), std::vector<FrameTime>(scans_.size()));
    wrong_.assign(scans_.size(), 0);
    for (std::size_t i = 0; i < scans_.size(); ++i)
      if (!settings_.track || i == 0 || scans_.sequence(i) != scans_.sequence(i - 1)) tasks_.push_back(i);
    tasks_.push_back(scans_.size());
  }

  /// Ends early when the program is interrupted. Throws std::runtime_error naming the first file that is wrong, unless
  /// scans are to be skipped then, and OutputError when a prediction cannot be written. The report's counts do not
  /// depend on `jobs`, nor on what earlier runs left in the output folder.
  const BenchmarkReport& run()
  {
    report_.before.skipped = scans_.skipped();
    {
      Progress progress("benchmark", scans_.size());
      runThreads(std::min(static_cast<std::size_t>(settings_.jobs), tasks_.size() - 1), [&] { work(progress); });
    }
    if (failure_) throw std::runtime_error(failure_->reason);
    for (std::size_t row = 0; row < report_.rows.size(); ++row)
      for (FrameTime& time : times_[row])
        if (!time.scan.empty()) report_.rows[row].times.push_back(std::move(time));
    report_.interrupted = interrupted() != 0;
    for (BenchmarkRow& row : report_.rows) row.evaluation.skipped = report_.before.skipped;
    if (!report_.interrupted && used_ == 0)
      throw std::runtime_error("none of the " + std::to_string(scans_.size()) + " scans could be used");
    return report_;
  }

  /// The scans [begin, end) alone, in this thread, whole sequences where objects are tracked; buffers last from part to
  /// part. The parts' reports add up to the whole's, without what scans().skipped() names. Throws as run() does, and
  /// nothing but that where no scan could be used.
  BenchmarkReport runPart(std::size_t begin, std::size_t end)
  {
    if (!part_) part_ = std::make_unique<Worker>(settings_, table_, emptyReport());
    part_->startReport(emptyReport());
    Progress silent("", end - begin, false, nullptr);
    failure_.reset();
    stop_ = false;
    workOn(begin, end, *part_, silent);
    if (failure_) throw std::runtime_error(failure_->reason);
    part_->countSwitches();
    for (std::size_t row = 0; row < part_->report.rows.size(); ++row)
      for (std::size_t i = begin; i < end; ++i)
        if (!times_[row][i].scan.empty())
          part_->report.rows[row].times.push_back(std::exchange(times_[row][i], FrameTime{}));
    return std::move(part_->report);
  }

  const BenchmarkScans& scans() const { return scans_; }
  /// Scans used so far, and how many of these needed no clustering: a run before wrote all their predictions.
  std::size_t used() const { return used_; }
  std::size_t resumed() const { return resumed_; }
  /// The scan of each sequence with the most true objects split or merged, over all rows; none where there is no such
  /// object.
  std::vector<std::size_t> worstScans() const
  {
    std::map<std::string, std::size_t> worst;
    for (std::size_t i = 0; i < scans_.size(); ++i)
      if (wrong_[i] > 0 && wrong_[i] > wrong_[worst.emplace(scans_.sequence(i), i).first->second])
        worst[scans_.sequence(i)] = i;
    std::vector<std::size_t> result;
    for (const auto& [sequence, scan] : worst) result.push_back(scan);
    return result;
  }

private:
  struct Failure
  {
    std::size_t scan;
    std::string reason;
  };

  /// What a thread has for itself.
  struct Worker
  {
    Worker(const BenchmarkSettings& settings, const std::shared_ptr<const ClassTable>& table, BenchmarkReport empty)
        : clusterer(settings, table), report(std::move(empty)), labels(settings.rows.size())
    {
      for (std::size_t row = 0; row < settings.rows.size() && settings.track; ++row)
        trackers.emplace_back(table), switches.emplace_back();
    }

    void startReport(BenchmarkReport empty)
    {
      report = std::move(empty);
      for (IdSwitches& one : switches) one = IdSwitches();
    }
    void countSwitches()
    {
      for (std::size_t row = 0; row < switches.size(); ++row)
        report.rows[row].evaluation.id_switches = switches[row].count();
    }

    ScanClusterer clusterer;
    BenchmarkReport report;
    ObjectErrors errors;
    BenchmarkScan scan;
    std::vector<std::vector<std::uint32_t>> labels;  ///< by row
    std::vector<std::uint32_t> no_instances, before;
    std::vector<LabelTracker> trackers;  ///< by row, as are the next; none when nothing is tracked
    std::vector<IdSwitches> switches;
  };

  BenchmarkReport emptyReport() const
  {
    std::vector<std::string> names;
    for (const RowSettings& row : settings_.rows) names.push_back(row.name);
    BenchmarkReport report(settings_.semantics.empty() ? "ground truth" : settings_.semantics, names, table_);
    for (BenchmarkRow& row : report.rows)
      if (settings_.track) row.evaluation.temporal.emplace(table_), row.evaluation.id_switches = 0;
    return report;
  }

  /// Scans are taken in order, so that the first bad one is reported however many threads there are.
  void work(Progress& progress)
  {
    Worker worker(settings_, table_, emptyReport());
    while (true)
    {
      const std::size_t task = next_++;
      if (task + 1 >= tasks_.size() || !workOn(tasks_[task], tasks_[task + 1], worker, progress)) break;
    }
    worker.countSwitches();
    const std::lock_guard<std::mutex> lock(mutex_);
    report_ += worker.report;
  }

  /// Whether to go on.
  bool workOn(std::size_t begin, std::size_t end, Worker& worker, Progress& progress)
  {
    for (LabelTracker& tracker : worker.trackers) tracker.start(scans_.sequenceOf(begin));
    for (IdSwitches& switches : worker.switches) switches.startSequence();
    for (std::size_t i = begin; i < end; ++i)
    {
      if (stop_ || interrupted() != 0) return false;
      try
      {
        process(i, worker);
      }
      catch (const OutputError& error)
      {
        return fail(i, error.what());
      }
      catch (const std::exception& error)
      {
        if (!settings_.keep_going) return fail(i, error.what());
        progress.note("skipped " + scans_.name(i) + ": " + error.what());
        worker.report.before.skipped.push_back({scans_.name(i), error.what()});
      }
      progress.step();
    }
    return true;
  }

  /// Of all that a prediction is made of but the settings.
  static std::string fingerprintOf(const BenchmarkScan& scan)
  {
    Fingerprint fingerprint;
    fingerprint.add(scan.points);
    fingerprint.add(scan.classes);
    return fingerprint.text();
  }

  /// False, for whoever is to end.
  bool fail(std::size_t scan, const std::string& reason)
  {
    stop_ = true;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure_ || scan < failure_->scan) failure_ = Failure{scan, reason};
    return false;
  }

  /// Counts nothing before all rows are through, so that a scan is in all of them or in none.
  void process(std::size_t i, Worker& worker)
  {
    scans_.read(i, worker.scan);
    const std::string made_of = outputs_.empty() ? "" : fingerprintOf(worker.scan);
    std::vector<FrameTime> times(settings_.rows.size());
    std::vector<std::size_t> open;
    for (std::size_t row = 0; row < settings_.rows.size(); ++row)
      if (outputs_.empty() || settings_.track ||
          !outputs_[row]->load(scans_.sequence(i), scans_.scanName(i), made_of, worker.scan.points.size(),
                               worker.labels[row], times[row]))
        open.push_back(row);
    if (!open.empty()) worker.clusterer.project(worker.scan);
    for (const std::size_t row : open)
    {
      PanopticCloud image;
      worker.clusterer.cluster(row, image, worker.labels[row], times[row]);
      times[row].scan = scans_.name(i);
      if (settings_.track) track(row, i, worker);
    }
    if (!outputs_.empty())
      for (const std::size_t row : open)
        outputs_[row]->save(scans_.sequence(i), scans_.scanName(i), made_of, worker.labels[row], times[row]);
    for (std::size_t row = 0; row < settings_.rows.size(); ++row) times_[row][i] = std::move(times[row]);
    if (settings_.evaluate && !worker.scan.truth.empty()) evaluate(i, worker);
    ++used_;
    if (open.empty()) ++resumed_;
  }

  /// A scan whose ids do not fit is no reason to skip it: none after it would.
  void track(std::size_t row, std::size_t i, Worker& worker) const
  {
    try
    {
      worker.trackers[row].track(scans_.numberOf(i), worker.scan.points, worker.labels[row]);
    }
    catch (const std::exception& error)
    {
      throw OutputError("sequence " + scans_.sequence(i) + ", row '" + settings_.rows[row].name + "': " + error.what());
    }
  }

  void evaluate(std::size_t i, Worker& worker)
  {
    const std::vector<std::uint32_t>& truth = worker.scan.truth;
    worker.no_instances.assign(truth.size(), 0);
    encodeLabels(worker.scan.classes, worker.no_instances, *table_, worker.before);
    worker.report.before.quality.addScan(worker.before.data(), truth.data(), truth.size());
    for (std::size_t row = 0; row < settings_.rows.size(); ++row)
    {
      EvaluationReport& evaluation = worker.report.rows[row].evaluation;
      evaluation.quality.addScan(worker.labels[row].data(), truth.data(), truth.size());
      if (settings_.track)
      {
        evaluation.temporal->addScan(scans_.sequence(i), evaluation.quality.lastScan());
        worker.switches[row].addScan(evaluation.quality.lastScan());
      }
      for (const TrueObject& object : worker.errors.judge(evaluation.quality.lastScan()))
      {
        evaluation.objects.add(object.outcome);
        if (object.outcome == ObjectOutcome::kSplit || object.outcome == ObjectOutcome::kMerged) ++wrong_[i];
      }
    }
    ++worker.report.scans[scans_.sequence(i)];
  }

  BenchmarkSettings settings_;
  std::shared_ptr<const ClassTable> table_;
  BenchmarkScans scans_;
  std::vector<std::unique_ptr<RowOutput>> outputs_;  ///< by row; empty when nothing is written
  std::vector<std::vector<FrameTime>> times_;        ///< by row and scan; unnamed where there is none
  std::vector<std::uint32_t> wrong_;                 ///< true objects split or merged, by scan

  std::vector<std::size_t> tasks_;  ///< where the scans begin that are done in one go, and the end
  std::atomic<std::size_t> next_{0}, used_{0}, resumed_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  BenchmarkReport report_;
  std::optional<Failure> failure_;
  std::unique_ptr<Worker> part_;  ///< of runPart()
};
}  // namespace lidar_panoptic_clustering
