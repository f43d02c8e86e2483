#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Why no scan comes through a nodelet, as one of its links tells.
struct Idle
{
  bool expected = false;  ///< nothing is wrong: nobody wants a scan
  std::string reason;
};

/// Of a nodelet that subscribes only while someone listens: nobody listens to `outputs` (full names), or what `input`
/// lacks. Empty links are those of a nodelet without listeners.
Idle describeIdle(std::uint32_t listeners, const std::string& outputs, const ros::Subscriber& input);

/// Counts the scans that go through a nodelet and reports them on /diagnostics once a second: rate, milliseconds a
/// stage, scans dropped, last error, and, where no scan comes, why. Its counting may be called from any thread.
class StreamDiagnostics
{
public:
  using StageMilliseconds = std::vector<std::pair<std::string, double>>;

  /// `idle` is asked with each report, in the callback queue of `private_nh`, after two seconds without a scan.
  void start(ros::NodeHandle& nh, ros::NodeHandle& private_nh, const std::string& name, std::function<Idle()> idle);

  /// No report runs or comes after it.
  void stop() { timer_.stop(); }

  /// Scans should come from now on.
  void expectScans();
  /// A scan went through.
  void processed(const StageMilliseconds& stages = {});
  /// A scan gave way to a newer one before its turn.
  void overwritten();
  /// A scan could not be used. Returns whether to log it: at most once in five seconds (roscpp's throttled macros keep
  /// their clock in a static that threads would race for).
  bool refused(const std::string& error);
  /// `count` scans had to be let go for want of something else, as `reason` says. Returns whether to log it, likewise.
  bool lacking(std::uint64_t count, const std::string& reason);
  /// A further figure or text to report, from now on, under a name of the nodelet's own.
  void setFigure(const std::string& name, std::uint64_t value) { setText(name, std::to_string(value)); }
  void setText(const std::string& name, const std::string& value);
  /// What the user should mend of `subject` though scans go through; it is the message while there is nothing worse.
  /// Empty: nothing (any more).
  void setWarning(const std::string& subject, const std::string& warning);

private:
  struct Counts
  {
    std::uint64_t processed = 0, overwritten = 0, lacking = 0, refused = 0;
  };

  bool noteError(const std::string& error);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper& status, const Idle& idle) const;
  Idle askIfIdle() const;
  std::string warning() const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  mutable std::mutex mutex_;
  Counts counts_, reported_;  ///< since the start, and up to the last report
  StageMilliseconds sums_, longest_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::string> warnings_;  ///< by subject
  std::string last_error_;
  ros::WallTime last_report_, last_logged_, last_sign_;
  std::function<Idle()> idle_;

  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering
