#include "core/plain_numbers.h"
#include "lidar_panoptic_clustering/core/point_types.h"
#include "lidar_panoptic_clustering/drawing/scan_figure.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "reporting/frame_report.h"
#include "reporting/report_output.h"
#include "reporting/stage_message.h"
#include "reporting/tracked_pictures.h"
#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct ReportConfig
{
  std::string algorithm = "all";  ///< or names with commas between them
  int frames = 0;                 ///< of each algorithm, then the process ends; 0 for no end
  double timeout_s = 15.0;        ///< without a new frame, then the process ends
  std::string picture;            ///< PNG file
  std::string report;             ///< file for the lines, standard output when empty
  bool track = false;             ///< the picture shows what the trackers NAME_tracker make of it

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("algorithm", self.algorithm, std::vector<std::string>{});
    visitor("frames", self.frames, 0, 2147483647);
    visitor("timeout_s", self.timeout_s, 0.1, 1e6);
    visitor("picture", self.picture, std::vector<std::string>{});
    visitor("report", self.report, std::vector<std::string>{});
    visitor("track", self.track);
  }
};

std::size_t countReturns(const PanopticCloud& cloud)
{
  std::size_t returns = 0;
  for (const auto& p : cloud.points)
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && (p.x != 0.0F || p.y != 0.0F || p.z != 0.0F))
      ++returns;
  return returns;
}
}  // namespace

/// Prints a line a frame of the cluster nodelets named after their algorithms (depth, euclidean, ...) in the same
/// namespace, and at the end a table and a picture; then it ends the process it runs in, nodelet manager and all.
///
/// ~input: what the cluster nodelets get, to count the scans they drop. Parameters: those of ReportConfig.
class FrameReportNodelet : public nodelet::Nodelet
{
public:
  ~FrameReportNodelet() override
  {
    // these wait for their callback under way
    watchdog_.stop();
    for (auto& subscriber : stages_) subscriber.shutdown();
    for (auto& subscriber : clouds_) subscriber.shutdown();
    tracked_.stop();
    if (report_) finish();
  }

private:
  using CloudPtr = boost::shared_ptr<const PanopticCloud>;

  struct Frame
  {
    CloudPtr cloud;
    double milliseconds = 0.0;  ///< of all stages
  };

  /// What came of an algorithm. The cloud and the figures of a scan come on two topics.
  struct Track
  {
    std::map<std::uint64_t, CloudPtr> waiting;  ///< by stamp: clouds whose figures are to come
    std::map<std::uint64_t, Frame> recent;      ///< by stamp: what the picture may show
    Frame shown;                                ///< what it does show
  };

  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    try
    {
      load();
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    // one callback at a time: a nodelet's handles share a queue that sees to it
    for (const auto& algorithm : algorithms_)
      stages_.push_back(subscribeChecked<diagnostic_msgs::DiagnosticArray>(
          getNodeHandle(), algorithm + "/stages", kQueue,
          [this, algorithm](const diagnostic_msgs::DiagnosticArrayConstPtr& m) { receiveFigures(algorithm, *m); },
          onError()));
    last_frame_ = ros::WallTime::now();
    watchdog_ =
        getNodeHandle().createWallTimer(ros::WallDuration(0.1), [this](const ros::WallTimerEvent&) { watch(); });
  }

  /// The cluster nodelets start with the first subscriber to their output, and so does the source. Done once they are
  /// all there, so that all of them get the first scan.
  void subscribeToClouds()
  {
    clouds_.push_back(subscribeChecked<LabelledCloud>(
        getPrivateNodeHandle(), "input", kQueue,
        [this](const boost::shared_ptr<const LabelledCloud>& cloud)
        {
          if (report_) report_->sent(cloud->header.stamp);
        },
        onError()));
    for (const auto& algorithm : algorithms_)
      clouds_.push_back(subscribeChecked<PanopticCloud>(
          getNodeHandle(), algorithm + "/output", kQueue,
          [this, algorithm](const CloudPtr& cloud) { receiveCloud(algorithm, cloud); }, onError()));
    if (!config_.track || config_.picture.empty()) return;
    for (const auto& algorithm : algorithms_) tracked_.listen(getNodeHandle(), algorithm);
  }

  MessageErrorCallback onError()
  {
    return [this](const std::string& error) { NODELET_ERROR("%s", error.c_str()); };
  }

  void load()
  {
    warnOfUnusedParameters(getPrivateNodeHandle(), namesOf(describeParameters(config_)));
    applyParameters(config_, readParameters(getPrivateNodeHandle(), describeParameters(config_)));
    algorithms_ = algorithmsOfList(config_.algorithm);
    for (const auto& algorithm : algorithms_) tracks_[algorithm];
    output_.open(config_.report);
    report_ = std::make_unique<FrameReport>(algorithms_, static_cast<std::size_t>(config_.frames));
  }

  void receiveCloud(const std::string& algorithm, const CloudPtr& cloud)
  {
    auto& waiting = tracks_[algorithm].waiting;
    waiting[cloud->header.stamp] = cloud;
    if (waiting.size() > kQueue) waiting.erase(waiting.begin());
  }

  void receiveFigures(const std::string& algorithm, const diagnostic_msgs::DiagnosticArray& message)
  {
    std::uint64_t stamp = 0;
    pcl_conversions::toPCL(message.header.stamp, stamp);
    auto& track = tracks_[algorithm];
    const auto found = track.waiting.find(stamp);
    if (!report_ || found == track.waiting.end() || message.status.empty()) return;
    const CloudPtr cloud = found->second;
    track.waiting.erase(track.waiting.begin(), std::next(found));

    FrameFigures figures = readStageMessage(message.status.front());
    figures.stamp_us = stamp;
    figures.points = countReturns(*cloud);
    if (!config_.picture.empty()) keep(track, stamp, {cloud, figures.totalMilliseconds()});
    const std::string line = report_->add(algorithm, std::move(figures));
    if (line.empty()) return;
    output_.print(line);
    last_frame_ = ros::WallTime::now();
    if (report_->complete()) finish(), ros::requestShutdown();
  }

  /// The picture shows one scan for all algorithms, where there is one: a slow algorithm lags behind and drops scans.
  void keep(Track& track, std::uint64_t stamp, const Frame& frame)
  {
    track.recent[stamp] = frame;
    if (track.recent.size() > kRecent) track.recent.erase(track.recent.begin());
    const bool common = std::all_of(tracks_.begin(), tracks_.end(),
                                    [stamp](const auto& t) { return t.second.recent.count(stamp) > 0; });
    for (auto& [name, other] : tracks_)
      if (common) other.shown = other.recent[stamp];
  }

  void watch()
  {
    const auto there = [](const ros::Subscriber& subscriber) { return subscriber.getNumPublishers() > 0; };
    if (!report_) return;
    if (clouds_.empty() && std::all_of(stages_.begin(), stages_.end(), there)) subscribeToClouds();
    if ((ros::WallTime::now() - last_frame_).toSec() < config_.timeout_s) return;
    NODELET_FATAL("no frame for %.0f s: does the source still send, and are its scans refused?", config_.timeout_s);
    finish(), ros::requestShutdown();
  }

  void finish()
  {
    if (!config_.picture.empty()) draw();
    output_.print(report_->summary());
    report_.reset();
  }

  void draw()
  {
    std::vector<ScanPanel> panels;
    for (const auto& algorithm : algorithms_)
    {
      if (const auto panel = tracked_.panel(algorithm))
      {
        panels.push_back(*panel);
        continue;
      }
      auto& [waiting, recent, shown] = tracks_[algorithm];
      if (!shown.cloud && !recent.empty()) shown = recent.rbegin()->second;
      if (!shown.cloud) continue;
      panels.push_back({algorithm, shown.cloud.get(), {}, fixedText(shown.milliseconds, 1) + " ms"});
    }
    try
    {
      if (panels.empty()) throw std::runtime_error("there was no frame to draw");
      drawScanFigure(panels, config_.picture);
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("no picture: %s", error.what());
    }
  }

  static constexpr std::uint32_t kQueue = 100;
  static constexpr std::size_t kRecent = 12;

  ReportConfig config_;
  ReportOutput output_;
  std::unique_ptr<FrameReport> report_;  ///< gone once it is finished
  std::vector<std::string> algorithms_;
  std::map<std::string, Track> tracks_;  ///< by algorithm
  ros::WallTime last_frame_;

  TrackedPictures tracked_;
  std::vector<ros::Subscriber> stages_, clouds_;
  ros::WallTimer watchdog_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::FrameReportNodelet, nodelet::Nodelet)
