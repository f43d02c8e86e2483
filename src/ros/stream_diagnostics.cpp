#include "ros/stream_diagnostics.h"

#include "core/plain_numbers.h"
#include "ros/linking.h"

#include <algorithm>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr double kIdleAfterS = 2.0;
}  // namespace

Idle describeIdle(std::uint32_t listeners, const std::string& outputs, const ros::Subscriber& input)
{
  if (listeners == 0 || !input) return {true, "nobody listens to " + outputs};
  const std::uint32_t publishers = input.getNumPublishers();
  if (publishers == 0) return {false, "no input: nobody publishes " + input.getTopic()};
  return {false, "no input: nothing comes on " + input.getTopic() + ", though it has " + std::to_string(publishers) +
                     (publishers == 1 ? " publisher" : " publishers")};
}

void StreamDiagnostics::start(ros::NodeHandle& nh, ros::NodeHandle& private_nh, const std::string& name,
                              std::function<Idle()> idle)
{
  idle_ = std::move(idle);
  last_report_ = last_sign_ = ros::WallTime::now();
  if (ros::isShuttingDown()) return;  // a publisher made now is none, and publishing on it ends the process
  {
    const std::lock_guard<std::mutex> lock(linkMutex());
    updater_ = std::make_unique<diagnostic_updater::Updater>(nh, private_nh, name);
  }
  updater_->setHardwareID("none");
  updater_->add("scans", this, &StreamDiagnostics::report);
  // update() would skip every call that comes a moment early, and all of them in simulated time that does not run
  timer_ = private_nh.createWallTimer(ros::WallDuration(1.0),
                                      [this](const ros::WallTimerEvent&) { updater_->force_update(); });
}

void StreamDiagnostics::expectScans()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  last_sign_ = ros::WallTime::now();
}

void StreamDiagnostics::processed(const StageMilliseconds& stages)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_.processed;
  last_sign_ = ros::WallTime::now();
  if (sums_.size() != stages.size()) sums_ = longest_ = StageMilliseconds(stages.size());
  for (std::size_t i = 0; i < stages.size(); ++i)
  {
    sums_[i].first = longest_[i].first = stages[i].first;
    sums_[i].second += stages[i].second;
    longest_[i].second = std::max(longest_[i].second, stages[i].second);
  }
}

void StreamDiagnostics::overwritten()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_.overwritten;
}

bool StreamDiagnostics::refused(const std::string& error)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counts_.refused;
  return noteError(error);
}

bool StreamDiagnostics::lacking(std::uint64_t count, const std::string& reason)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  counts_.lacking += count;
  return noteError(reason);
}

void StreamDiagnostics::setText(const std::string& name, const std::string& value)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  texts_[name] = value;
}

void StreamDiagnostics::setWarning(const std::string& subject, const std::string& warning)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  warnings_[subject] = warning;
}

std::string StreamDiagnostics::warning() const
{
  std::string text;
  for (const auto& [subject, warning] : warnings_)
    if (!warning.empty()) text += (text.empty() ? "" : "; ") + warning;
  return text;
}

bool StreamDiagnostics::noteError(const std::string& error)
{
  last_error_ = error;
  const auto now = last_sign_ = ros::WallTime::now();
  if (now - last_logged_ < ros::WallDuration(5.0)) return false;
  last_logged_ = now;
  return true;
}

Idle StreamDiagnostics::askIfIdle() const
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if ((ros::WallTime::now() - last_sign_).toSec() < kIdleAfterS) return {};
  }
  return idle_ ? idle_() : Idle{true, "no scans"};  // without the lock: it may ask under one of its own
}

void StreamDiagnostics::summarize(diagnostic_updater::DiagnosticStatusWrapper& status, const Idle& idle) const
{
  using Level = diagnostic_msgs::DiagnosticStatus;
  const std::uint64_t processed = counts_.processed - reported_.processed;
  if (counts_.refused > reported_.refused)
    status.summary(processed == 0 ? Level::ERROR : Level::WARN, "scans refused: " + last_error_);
  else if (counts_.lacking > reported_.lacking)
    status.summary(processed == 0 ? Level::ERROR : Level::WARN, "scans dropped: " + last_error_);
  else if (counts_.overwritten - reported_.overwritten > processed)
    status.summary(Level::WARN, "slower than the scans come: more than half of them dropped");
  else if (!idle.reason.empty() && !idle.expected)
    status.summary(Level::WARN, idle.reason);
  else if (!warning().empty())
    status.summary(Level::WARN, warning());
  else if (!idle.reason.empty())
    status.summary(Level::OK, idle.reason);
  else
    status.summary(Level::OK, counts_.processed > 0 ? "processing scans" : "started");
}

void StreamDiagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  const Idle idle = askIfIdle();
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = ros::WallTime::now();
  const double seconds = (now - last_report_).toSec();
  const std::uint64_t processed = counts_.processed - reported_.processed;
  summarize(status, idle);

  const PlainNumbers plain;
  status.addf("rate [Hz]", "%.2f", seconds > 0.0 ? static_cast<double>(processed) / seconds : 0.0);
  for (std::size_t i = 0; i < sums_.size() && processed > 0; ++i)
    status.addf(sums_[i].first + " [ms]", "mean %.3f, longest %.3f", sums_[i].second / static_cast<double>(processed),
                longest_[i].second);
  status.add("scans processed", std::to_string(counts_.processed));
  status.add("scans dropped", std::to_string(counts_.overwritten + counts_.lacking));
  status.add("scans refused", std::to_string(counts_.refused));
  for (const auto& [name, value] : texts_) status.add(name, value);
  if (const std::string text = warning(); !text.empty()) status.add("warning", text);
  status.add("last error", last_error_.empty() ? "none" : last_error_);

  last_report_ = now;
  reported_ = counts_;
  sums_.clear(), longest_.clear();
}
}  // namespace lidar_panoptic_clustering
