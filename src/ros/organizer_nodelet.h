#pragma once

#include "ros/frame_history.h"
#include "ros/label_matcher.h"
#include "ros/latched_input.h"
#include "ros/scan_organizer.h"
#include "ros/stream_diagnostics.h"
#include "ros/unlabelled_outputs.h"

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace lidar_panoptic_clustering
{
struct OrganizerNodeletConfig
{
  ScanOrganizerConfig organizer;
  LabelMatcherConfig matcher;
  int kept_frames = 5;  ///< clouds that wait for their instances; one is clustered, the next waits for that

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    ScanOrganizerConfig::visit(self.organizer, visitor);
    LabelMatcherConfig::visit(self.matcher, visitor);
    visitor("kept_frames", self.kept_frames, 2, 100);
  }
};

/// ~input sensor_msgs/PointCloud2 as a driver publishes it -> ~output organised LabelledCloud; and the cluster
/// nodelet's output of that, on ~panoptic, -> ~output_original, the driver's cloud with a label and an instance a
/// point.
///
/// The classes come with the cloud, on ~label_input as sensor_msgs/Image or as a second PointCloud2, or from the
/// geometry, as the parameter labels says. A cloud waits until its labels come; one that more than queue_size others
/// have overtaken, or whose successor's labels have come, is dropped and counted.
///
/// What a network needs goes out before the labels come, while someone listens: the organised cloud on ~unlabelled, its
/// ranges and intensities as images on ~range and ~intensity, see UnlabelledOutputs.
///
/// Clouds go by pointer inside a nodelet manager. Subscribes only while someone listens to an output, to ~panoptic only
/// while someone listens to ~output_original. What cannot be used is dropped, logged once in a while and shown in the
/// diagnostics; the next one is looked at afresh. A latched cloud is worked on once a second, for those who begin to
/// listen later, here or further down.
///
/// Parameters: those of OrganizerNodeletConfig.
class OrganizerNodelet : public nodelet::Nodelet
{
public:
  ~OrganizerNodelet() override;

private:
  // The node handles of a nodelet without "MT" in their name call one callback at a time, so that only connect(), which
  // onInit() may overlap, needs a lock.
  using CloudPtr = sensor_msgs::PointCloud2ConstPtr;

  void onInit() override;
  void advertise();

  void connect();
  void connectPanoptic();
  void connectLabels();
  bool labelledIsWanted() const { return output_.getNumSubscribers() > 0 || original_.getNumSubscribers() > 0; }
  bool isPublished();
  Idle describeIdle();

  void receive(const CloudPtr& cloud);
  /// Once more a latched cloud that has come before, with the labels it has got.
  void repeat(const CloudPtr& cloud);
  /// For those who make its labels. It is kept for them, so that they fit what was seen.
  bool organizeEarly(const CloudPtr& message);
  void match(const std::optional<LabelMatcher::Pair>& pair);

  void process(const CloudPtr& message, const LabelPart& labels);
  void organize(const sensor_msgs::PointCloud2& message, OrganizedFrame& frame);
  double label(const sensor_msgs::PointCloud2& message, const LabelPart& labels, bool all_points,
               OrganizedFrame& frame);
  void carryBack(const PanopticCloud& panoptic);

  /// What clouds are taken for: once in the log and from then on in the diagnostics, again when it changes.
  void tellLayout();
  /// The ground of each scan in the diagnostics; the sensor's height over it once in the log, and that there is none.
  void tellGround();
  /// Of what is doubtful about `subject`: once in the log, and in the diagnostics for as long as it holds.
  void warn(const char* subject, const std::string& doubt);
  void refuse(const std::string& error);
  /// Does something with a cloud that came on `topic`; a cloud that cannot be used is dropped, and that is said.
  template <class Work>
  bool attempt(const char* topic, Work work);

  OrganizerNodeletConfig config_;
  std::unique_ptr<ScanOrganizer> organizer_;
  std::unique_ptr<LabelMatcher> matcher_;
  std::unique_ptr<FrameHistory> history_;
  LatchedInput<sensor_msgs::PointCloud2> latched_;
  std::optional<LabelMatcher::Pair> latched_pair_;  ///< the latched cloud and its labels
  std::uint64_t without_scan_ = 0;
  std::uint32_t told_layout_ = 0;  ///< FoundLayout::change
  bool told_height_ = false, told_no_ground_ = false;
  std::uint64_t without_ground_ = 0;
  std::map<std::string, std::string> doubts_;  ///< by subject
  StreamDiagnostics diagnostics_;

  std::mutex connect_mutex_;
  bool closed_ = false;
  ros::Publisher output_, original_;
  UnlabelledOutputs unlabelled_;
  ros::Subscriber input_, labels_, panoptic_;
};
}  // namespace lidar_panoptic_clustering
