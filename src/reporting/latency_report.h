#pragma once

#include "ros/stamp_matcher.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// How long scans take from a graph's input to its output, told apart by their stamps, in percentiles.
///
/// A scan counts once its input, its output and the figure of the work on it are there, in whichever order they come;
/// each of the three streams is in order of stamps. Outputs for which no input was seen are passed over. Not shared
/// between threads.
class LatencyReport
{
public:
  using Time = std::chrono::steady_clock::time_point;

  /// The first `warm_up` scans are left out. Those beyond `scans` after them are too; 0 for no limit.
  LatencyReport(std::size_t warm_up, std::size_t scans);

  /// A scan went in. One that comes a second time with the same stamp is passed over.
  void sent(std::uint64_t stamp_us, Time when);

  /// It came out; `age_ms` after its stamp, which is a time of another clock.
  void returned(std::uint64_t stamp_us, Time when, double age_ms);

  /// The nodelet's own figure of its work on it.
  void worked(std::uint64_t stamp_us, double work_ms);

  /// Whether the limit is reached; never without one.
  bool complete() const { return limit_ > 0 && scans_.size() >= limit_; }

  /// The scans that went in between the first and the last that count, and did not come out.
  std::size_t dropped() const;

  /// Three lines of percentiles (nearest rank) in milliseconds under a head: from input to output, from stamp to
  /// output, and the work. Ends with a line that begins with "done" when the report is complete or has no limit, and
  /// with "ended early" otherwise.
  std::string table(const std::string& graph, const std::string& algorithm) const;

private:
  /// When a scan was seen, and how old it was then (at the output).
  struct Moment
  {
    Time when;
    double age_ms = 0.0;
  };
  struct Scan
  {
    double latency_ms = 0.0, age_ms = 0.0, work_ms = 0.0;
    std::uint64_t lost_before = 0;  ///< older inputs without output
  };

  void match(std::uint64_t stamp_us, const StampMatcher<Moment>::Pair& input_and_output);
  void add(const StampMatcher<Scan>::Pair& times_and_work);
  std::string row(const std::string& leading, const char* what, double Scan::*member) const;

  std::size_t warm_up_, limit_;
  std::uint64_t last_sent_us_ = 0;
  StampMatcher<Moment> moments_;  ///< of input and output
  StampMatcher<Scan> outputs_;    ///< times, and the work
  std::vector<Scan> scans_;
};
}  // namespace lidar_panoptic_clustering
