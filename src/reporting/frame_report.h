#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// What an algorithm made of one scan.
struct FrameFigures
{
  std::uint64_t stamp_us = 0;
  std::size_t points = 0, things = 0, instances = 0;   ///< returns, returns on things, objects
  std::vector<std::pair<std::string, double>> stages;  ///< name and milliseconds, in the order of the work

  double totalMilliseconds() const;
};

/// The value below or at which the share `quantile` (0 to 1) of the values lies (nearest rank): 0 is the minimum, 0.5
/// the lower median, 1 the maximum. 0 for no values.
double quantileOf(std::vector<double> values, double quantile);

/// Prints the frames of one or several algorithms as lines of a table, and sums them up.
///
/// Columns: frame, algorithm, points, things, instances, milliseconds a stage and in total. The stages are those of the
/// first frame added; a stage that a later frame lacks counts as 0.
class FrameReport
{
public:
  /// Frames of an algorithm beyond `frames` are not counted; 0 for no limit.
  FrameReport(const std::vector<std::string>& algorithms, std::size_t frames);

  /// A scan left its source, `stamp_us` after the last one's; for the count of dropped scans.
  void sent(std::uint64_t stamp_us) { sent_.push_back(stamp_us); }

  /// Counts a frame and returns its line, with the table's head before the first; empty when it is beyond the limit.
  /// Throws std::invalid_argument for an algorithm that was not announced.
  std::string add(const std::string& algorithm, FrameFigures figures);

  /// Whether every algorithm reached the limit; never without one.
  bool complete() const;

  /// A line an algorithm: frames; scans sent between its first and last frame that it did not work on; means of points,
  /// things and instances; medians of the stages; median, 95th percentile and maximum of the total. Ends with a line
  /// that begins with "done" when the report is complete or has no limit, and with "ended early" otherwise.
  std::string summary() const;

private:
  struct Series
  {
    std::string algorithm;
    std::vector<FrameFigures> frames;
  };

  std::size_t dropped(const Series& series) const;
  std::string head(const std::string& leading) const;
  std::string summaryOf(const Series& series) const;

  std::size_t limit_;
  std::vector<Series> series_;
  std::vector<std::string> stages_;
  std::vector<std::uint64_t> sent_;
};
}  // namespace lidar_panoptic_clustering
