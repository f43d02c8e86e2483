#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/core/point_types.h"
#include "reporting/latency_report.h"
#include "reporting/report_output.h"
#include "reporting/stage_message.h"
#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <ros/callback_queue_interface.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct LatencyConfig
{
  int frames = 200;         ///< to measure, then the process ends; 0 for no end
  int warm_up = 20;         ///< before them, and left out
  double timeout_s = 30.0;  ///< without a scan that came out, then the process ends
  std::string report;       ///< file for the table, standard output when empty

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("frames", self.frames, 0, 100000);
    visitor("warm_up", self.warm_up, 0, 100000);
    visitor("timeout_s", self.timeout_s, 0.1, 3600.0);
    visitor("report", self.report, std::vector<std::string>{});
  }
};

/// Runs callbacks where they are added to it. For a subscriber that is the thread of a publisher in the same process,
/// in the midst of publish(), or the transport's; roscpp has unsubscribing wait for it.
class ImmediateQueue : public ros::CallbackQueueInterface
{
public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override
  {
    // another publisher's message is in the callback
    while (callback->call() == ros::CallbackInterface::TryAgain) std::this_thread::yield();
  }
  void removeByID(std::uint64_t) override {}
};
}  // namespace

/// Measures how long scans take through a cluster nodelet, and prints percentiles of it; then it ends the process it
/// runs in, nodelet manager and all.
///
/// ~input and ~output: what the cluster nodelet gets (LabelledCloud) and gives (PanopticCloud); ~stages: its topic of
/// that name. For each scan that came out, told by its stamp:
/// - input to output callback: from the begin of the input's callback to that of the output's, by a steady clock.
/// - stamp to output callback: the age of the output by the ROS clock. It includes all that lies between the source's
///   setting of the stamp and the input's callback; where the stamp is the time of publication, as in latency.launch,
///   that is the source's serialisation for another process.
/// - the nodelet's own work: the sum of the stages it reports. What is left is transport, queues and threads.
///
/// This nodelet belongs into the source's process. There the input costs it nothing, a pointer, and both times are of
/// one machine. Where the cluster nodelet runs in another process, the output callback is where any consumer of a third
/// process would have its own: the clouds are serialised, sent and read twice, once each way.
///
/// The output waits for a thread of the manager as for any nodelet there, but behind no other callback of this one. The
/// input does not wait: were its callback late, on a busy machine, the scan's way would look short.
///
/// Parameters: those of LatencyConfig.
class LatencyNodelet : public nodelet::Nodelet
{
public:
  ~LatencyNodelet() override
  {
    // these wait for their callback under way
    watchdog_.stop();
    for (auto* subscriber : {&input_, &output_, &stages_}) subscriber->shutdown();
    if (report_) finish();
  }

private:
  using Clock = std::chrono::steady_clock;
  using Stages = diagnostic_msgs::DiagnosticArray;

  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    openQueue(getMTPrivateNodeHandle());
    try
    {
      warnOfUnusedParameters(getPrivateNodeHandle(), namesOf(describeParameters(config_)));
      applyParameters(config_, readParameters(getPrivateNodeHandle(), describeParameters(config_)));
      printer_.open(config_.report);
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    report_ = std::make_unique<LatencyReport>(static_cast<std::size_t>(config_.warm_up),
                                              static_cast<std::size_t>(config_.frames));
    last_scan_ = ros::WallTime::now();
    auto& nh = getMTPrivateNodeHandle();
    stages_ = subscribeChecked<Stages>(
        nh, "stages", kQueue,
        [this](const boost::shared_ptr<const Stages>& message, const Arrival& arrival)
        { receiveStages(*message, arrival); },
        onError());
    input_ = subscribeChecked<LabelledCloud>(
        nh, "input", kQueue, [this](const auto& cloud) { receiveInput(*cloud); }, onError(), &input_queue_);
    watchdog_ =
        getNodeHandle().createWallTimer(ros::WallDuration(0.1), [this](const ros::WallTimerEvent&) { watch(); });
  }

  MessageErrorCallback onError()
  {
    return [this](const std::string& error) { NODELET_ERROR("%s", error.c_str()); };
  }

  void receiveInput(const LabelledCloud& cloud)
  {
    const auto now = Clock::now();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (report_) report_->sent(cloud.header.stamp, now);
    endIfComplete();
  }

  void receiveOutput(const PanopticCloud& cloud)
  {
    const auto now = Clock::now();
    const double age_s = (ros::Time::now() - pcl_conversions::fromPCL(cloud.header.stamp)).toSec();
    const std::lock_guard<std::mutex> lock(mutex_);
    last_scan_ = ros::WallTime::now();
    if (report_) report_->returned(cloud.header.stamp, now, 1e3 * age_s);
    endIfComplete();
  }

  void receiveStages(const Stages& message, const Arrival& arrival)
  {
    if (message.status.empty()) return;
    std::uint64_t stamp = 0;
    pcl_conversions::toPCL(message.header.stamp, stamp);
    const double work_ms = readStageMessage(message.status.front()).totalMilliseconds();
    const std::lock_guard<std::mutex> lock(mutex_);
    algorithm_ = message.status.front().hardware_id;
    graph_ = arrival.sender == ros::this_node::getName() ? "one manager" : "across processes";
    if (report_) report_->worked(stamp, work_ms);
    endIfComplete();
  }

  /// The cluster nodelet starts with the first subscriber to its output. Done once source and nodelet are both there:
  /// where one thread advertises while another subscribes, roscpp may connect the two twice.
  void subscribeToOutput()
  {
    output_ = subscribeChecked<PanopticCloud>(
        getMTPrivateNodeHandle(), "output", kQueue, [this](const auto& cloud) { receiveOutput(*cloud); }, onError());
  }

  void watch()
  {
    if (!output_ && input_.getNumPublishers() > 0 && stages_.getNumPublishers() > 0) subscribeToOutput();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!report_ || (ros::WallTime::now() - last_scan_).toSec() < config_.timeout_s) return;
    NODELET_FATAL("no scan came out for %.0f s: does the source still send, and are its scans refused?",
                  config_.timeout_s);
    finish(), ros::requestShutdown();
  }

  void endIfComplete()
  {
    if (report_ && report_->complete()) finish(), ros::requestShutdown();
  }

  void finish()
  {
    printer_.print(report_->table(graph_, algorithm_));
    report_.reset();
  }

  static constexpr std::uint32_t kQueue = 100;

  LatencyConfig config_;
  ReportOutput printer_;
  std::mutex mutex_;                       ///< of all below
  std::unique_ptr<LatencyReport> report_;  ///< gone once it is finished
  std::string graph_ = "none", algorithm_ = "none";
  ros::WallTime last_scan_;

  ImmediateQueue input_queue_;
  ros::Subscriber input_, output_, stages_;
  ros::WallTimer watchdog_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::LatencyNodelet, nodelet::Nodelet)
