#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <map>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
/// Chooses what of /diagnostics is worth a line on the screen of the one who started the nodelets.
///
/// A nodelet's state is told when it changes, at most every five seconds and worse ones at once; one that is not OK
/// again every minute. So is that a nodelet is not heard of.
class DiagnosticsEcho
{
public:
  struct Line
  {
    int level;  ///< of diagnostic_msgs/DiagnosticStatus
    std::string text;
  };

  /// Listens for `nodelets` (full names). `manager` is where they are loaded, and where they log; empty where their log
  /// is on the same screen, and what stands there is not repeated.
  DiagnosticsEcho(const std::vector<std::string>& nodelets, std::string manager);

  /// Times [s] are of any clock that only goes forward.
  std::vector<Line> take(const diagnostic_msgs::DiagnosticArray& message, double now_s);
  /// Of nodelets that have not been heard of for a while.
  std::vector<Line> missing(double now_s);

private:
  struct State
  {
    double heard_s = 0.0, told_s = 0.0;  ///< 0: not yet
    int level = -1;                      ///< of the line told last
    std::string message;
    bool failed = false;  ///< was not loaded: nothing more is to be heard
  };

  bool isLoggedHere(const diagnostic_msgs::DiagnosticStatus& status) const;
  static bool isWorthALine(const State& state, int level, const std::string& message, double now_s);

  std::string manager_;
  double start_s_ = 0.0;
  std::map<std::string, State> states_;  ///< by nodelet
};
}  // namespace lidar_panoptic_clustering
