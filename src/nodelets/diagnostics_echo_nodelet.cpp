#include "reporting/diagnostics_echo.h"
#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct EchoConfig
{
  std::string nodelets;  ///< names, with blanks in between
  std::string manager;   ///< where they are loaded and log; empty: in a process whose log is on the same screen

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("nodelets", self.nodelets, std::vector<std::string>{});
    visitor("manager", self.manager, std::vector<std::string>{});
  }
};
}  // namespace

/// Logs what some nodelets say of themselves on /diagnostics: that no input comes, that nobody listens, why scans are
/// refused, why one was not loaded. Their own log stands where their manager runs; this one, in a process of its own
/// (`nodelet_manager standalone`), stands where it was started.
///
/// Parameters: those of EchoConfig.
class DiagnosticsEchoNodelet : public nodelet::Nodelet
{
public:
  ~DiagnosticsEchoNodelet() override
  {
    timer_.stop();
    diagnostics_.shutdown();
  }

private:
  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    auto& nh = getPrivateNodeHandle();
    EchoConfig config;
    try
    {
      warnOfUnusedParameters(nh, namesOf(describeParameters(config)));
      applyParameters(config, readParameters(nh, describeParameters(config)));
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    std::vector<std::string> names;
    std::istringstream words(config.nodelets);
    for (std::string name; words >> name;) names.push_back(getNodeHandle().resolveName(name));
    echo_ = std::make_unique<DiagnosticsEcho>(
        names, config.manager.empty() ? "" : getNodeHandle().resolveName(config.manager));
    // timer and subscriber share the nodelet's queue: one callback at a time
    diagnostics_ = subscribeChecked<diagnostic_msgs::DiagnosticArray>(
        nh, "/diagnostics", 100,
        [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { log(echo_->take(*message, now())); },
        [this](const std::string& error) { NODELET_WARN("%s", error.c_str()); });
    timer_ =
        nh.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { log(echo_->missing(now())); });
  }

  static double now() { return ros::WallTime::now().toSec(); }

  void log(const std::vector<DiagnosticsEcho::Line>& lines)
  {
    using Status = diagnostic_msgs::DiagnosticStatus;
    for (const auto& line : lines)
      if (line.level == Status::OK)
        NODELET_INFO("%s", line.text.c_str());
      else if (line.level == Status::WARN)
        NODELET_WARN("%s", line.text.c_str());
      else
        NODELET_ERROR("%s", line.text.c_str());
  }

  std::unique_ptr<DiagnosticsEcho> echo_;
  ros::Subscriber diagnostics_;
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::DiagnosticsEchoNodelet, nodelet::Nodelet)
