#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
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

private:
  struct Counts
  {
    std::uint64_t processed = 0, overwritten = 0, refused = 0;
  };

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::mutex mutex_;
  Counts counts_, reported_;  ///< since the start, and up to the last report
  StageMilliseconds sums_, longest_;
  std::string last_error_;
  ros::WallTime last_report_, last_logged_;

  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering
