#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Counts the scans that go through a nodelet and reports them on /diagnostics once a second: rate, milliseconds a
/// stage, scans dropped, last error. Its counting may be called from any thread.
class StreamDiagnostics
{
public:
  using StageMilliseconds = std::vector<std::pair<std::string, double>>;

  void start(ros::NodeHandle& nh, ros::NodeHandle& private_nh, const std::string& name);

  /// No report runs or comes after it.
  void stop() { timer_.stop(); }

  /// A scan went through.
  void processed(const StageMilliseconds& stages = {});
  /// A scan gave way to a newer one before its turn.
  void overwritten();
  /// A scan could not be used. Returns whether to log it: at most once in five seconds (roscpp's throttled macros keep
  /// their clock in a static that threads would race for).
  bool refused(const std::string& error);
  /// `count` scans had to be let go for want of something else, as `reason` says. Returns whether to log it, likewise.
  bool lacking(std::uint64_t count, const std::string& reason);
  /// A further number to report, from now on, under a name of the nodelet's own.
  void setFigure(const std::string& name, std::uint64_t value);
  /// What the user should mend though scans go through; it is the message while there is nothing worse.
  void setWarning(const std::string& warning);

private:
  struct Counts
  {
    std::uint64_t processed = 0, overwritten = 0, lacking = 0, refused = 0;
  };

  bool noteError(const std::string& error);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::mutex mutex_;
  Counts counts_, reported_;  ///< since the start, and up to the last report
  StageMilliseconds sums_, longest_;
  std::map<std::string, std::uint64_t> figures_;
  std::string last_error_, warning_;
  ros::WallTime last_report_, last_logged_;

  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering
