#include "reporting/diagnostics_echo.h"

#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
using Status = diagnostic_msgs::DiagnosticStatus;

constexpr double kLeastPauseS = 5.0, kReminderS = 60.0, kMissingAfterS = 15.0;

/// "/birds_eye" of "birds_eye: scans".
std::string nodeletOf(const Status& status)
{
  const std::string name = status.name.substr(0, status.name.find(": "));
  return name.rfind('/', 0) == 0 ? name : "/" + name;
}
bool isLoadFailure(const Status& status)
{
  return status.message.rfind("not loaded: ", 0) == 0;
}
}  // namespace

DiagnosticsEcho::DiagnosticsEcho(const std::vector<std::string>& nodelets, std::string manager)
    : manager_(std::move(manager))
{
  for (const std::string& nodelet : nodelets) states_[nodelet];
}

/// What a nodelet logs stands in its message too: its last error, its warning, and why it was not loaded.
bool DiagnosticsEcho::isLoggedHere(const Status& status) const
{
  if (!manager_.empty()) return false;
  if (isLoadFailure(status)) return true;
  for (const auto& item : status.values)
    if ((item.key == "last error" || item.key == "warning") && status.message.find(item.value) != std::string::npos)
      return true;
  return false;
}

bool DiagnosticsEcho::isWorthALine(const State& state, int level, const std::string& message, double now_s)
{
  if (state.level < 0 || level > state.level) return true;
  const bool changed = level != state.level || message != state.message;
  return now_s - state.told_s >= (changed ? kLeastPauseS : kReminderS) && (changed || level > Status::OK);
}

std::vector<DiagnosticsEcho::Line> DiagnosticsEcho::take(const diagnostic_msgs::DiagnosticArray& message, double now_s)
{
  std::vector<Line> lines;
  for (const Status& status : message.status)
  {
    const auto found = states_.find(nodeletOf(status));
    if (found == states_.end()) continue;
    auto& [nodelet, state] = *found;
    state.heard_s = now_s;
    state.failed = isLoadFailure(status);
    if (isLoggedHere(status) || !isWorthALine(state, status.level, status.message, now_s)) continue;
    state.told_s = now_s, state.level = status.level, state.message = status.message;
    lines.push_back({status.level, nodelet + ": " + status.message});
  }
  return lines;
}

std::vector<DiagnosticsEcho::Line> DiagnosticsEcho::missing(double now_s)
{
  if (start_s_ == 0.0) start_s_ = now_s;
  std::vector<Line> lines;
  for (auto& [nodelet, state] : states_)
  {
    const double since = state.heard_s > 0.0 ? state.heard_s : start_s_;
    if (state.failed || now_s - since < kMissingAfterS) continue;
    const std::string message =
        "not heard of" + (manager_.empty() ? "" : "; does its nodelet manager " + manager_ + " run?");
    if (!isWorthALine(state, Status::ERROR, message, now_s)) continue;
    state.told_s = now_s, state.level = Status::ERROR, state.message = message;
    lines.push_back({Status::ERROR, nodelet + ": " + message});
  }
  return lines;
}
}  // namespace lidar_panoptic_clustering
