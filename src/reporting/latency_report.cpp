#include "reporting/latency_report.h"

#include "reporting/format_text.h"
#include "reporting/frame_report.h"

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::size_t kMostWaiting = 1000;  ///< a second at 1000 Hz
}  // namespace

LatencyReport::LatencyReport(std::size_t warm_up, std::size_t scans)
    : warm_up_(warm_up), limit_(scans), moments_(kMostWaiting), outputs_(kMostWaiting)
{
  scans_.reserve(limit_);
}

void LatencyReport::sent(std::uint64_t stamp_us, Time when)
{
  if (stamp_us == last_sent_us_) return;
  last_sent_us_ = stamp_us;
  if (const auto pair = moments_.addLeft(stamp_us, {when, 0.0})) match(stamp_us, *pair);
}

void LatencyReport::returned(std::uint64_t stamp_us, Time when, double age_ms)
{
  if (const auto pair = moments_.addRight(stamp_us, {when, age_ms})) match(stamp_us, *pair);
}

void LatencyReport::match(std::uint64_t stamp_us, const StampMatcher<Moment>::Pair& input_and_output)
{
  const auto& [input, output] = input_and_output;
  Scan scan;
  scan.latency_ms = std::chrono::duration<double, std::milli>(output.when - input.when).count();
  scan.age_ms = output.age_ms;
  scan.lost_before = moments_.unmatchedLeft();
  if (const auto pair = outputs_.addLeft(stamp_us, scan)) add(*pair);
}

void LatencyReport::worked(std::uint64_t stamp_us, double work_ms)
{
  Scan work;
  work.work_ms = work_ms;
  if (const auto pair = outputs_.addRight(stamp_us, work)) add(*pair);
}

void LatencyReport::add(const StampMatcher<Scan>::Pair& times_and_work)
{
  if (warm_up_ > 0)
  {
    --warm_up_;
    return;
  }
  if (complete()) return;
  scans_.push_back(times_and_work.first);
  scans_.back().work_ms = times_and_work.second.work_ms;
}

std::size_t LatencyReport::dropped() const
{
  return scans_.empty() ? 0 : scans_.back().lost_before - scans_.front().lost_before;
}

std::string LatencyReport::table(const std::string& graph, const std::string& algorithm) const
{
  std::string text =
      formatText("\n%-16s %-13s %6s %7s  %-26s", "graph", "algorithm", "scans", "dropped", "milliseconds");
  for (const char* column : {"least", "median", "90 %", "95 %", "99 %", "longest"}) text += formatText(" %8s", column);
  const std::string leading =
      formatText("%-16s %-13s %6zu %7zu", graph.c_str(), algorithm.c_str(), scans_.size(), dropped());
  text += '\n' + row(leading, "input to output callback", &Scan::latency_ms);
  text += row("", "stamp to output callback", &Scan::age_ms);
  text += row("", "the nodelet's own work", &Scan::work_ms);
  if (limit_ == 0) return text + "done: ended from outside, as no number of scans was set\n";
  return text +
         formatText(complete() ? "done: %zu of %zu scans\n" : "ended early: %zu of %zu scans\n", scans_.size(), limit_);
}

std::string LatencyReport::row(const std::string& leading, const char* what, double Scan::*member) const
{
  std::vector<double> values;
  values.reserve(scans_.size());
  for (const Scan& scan : scans_) values.push_back(scan.*member);
  std::string line = formatText("%-45s  %-26s", leading.c_str(), what);
  for (const double quantile : {0.0, 0.5, 0.9, 0.95, 0.99, 1.0})
    line += formatText(" %8.2f", quantileOf(values, quantile));
  return line + '\n';
}
}  // namespace lidar_panoptic_clustering
