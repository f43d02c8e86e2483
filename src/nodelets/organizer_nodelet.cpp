#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "lidar_panoptic_clustering/projection/original_cloud.h"
#include "lidar_panoptic_clustering/projection/original_labeller.h"
#include "lidar_panoptic_clustering/scan_to_objects/scan_labeller.h"
#include "ros/cloud_subscription.h"
#include "ros/frame_history.h"
#include "ros/label_matcher.h"
#include "ros/original_message.h"
#include "ros/parameter_server.h"
#include "ros/stream_diagnostics.h"
#include "ros/unlabelled_outputs.h"

#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct OrganizerNodeletConfig
{
  OrganizerConfig organizer;
  ScanLabellerConfig labeller;
  LabelMatcherConfig matcher;
  int kept_frames = 5;        ///< clouds that wait for their instances; one is clustered, the next waits for that
  bool float_fields = false;  ///< label and instance of ~output_original as float32, as pcl_ros's filters read them

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    OrganizerConfig::visit(self.organizer, visitor);
    ScanLabellerConfig::visit(self.labeller, visitor);
    LabelMatcherConfig::visit(self.matcher, visitor);
    visitor("kept_frames", self.kept_frames, 2, 100);
    visitor("float_fields", self.float_fields);
  }
};

RawImage viewOf(const sensor_msgs::Image& image)
{
  return {image.width,    image.height,      image.step,       image.is_bigendian != 0,
          image.encoding, image.data.data(), image.data.size()};
}
}  // namespace

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
/// diagnostics; the next one is looked at afresh.
///
/// Parameters: those of OrganizerNodeletConfig.
class OrganizerNodelet : public nodelet::Nodelet
{
public:
  ~OrganizerNodelet() override
  {
    {
      const std::lock_guard<std::mutex> lock(connect_mutex_);
      closed_ = true;
    }
    // each of these waits for its callback under way; without the lock, which connect() may be waiting for
    diagnostics_.stop();
    input_.shutdown();
    labels_.shutdown();
    panoptic_.shutdown();
    output_.shutdown();
    original_.shutdown();
    unlabelled_.shutdown();
  }

private:
  // The node handles of a nodelet without "MT" in their name call one callback at a time, so that only connect(), which
  // onInit() may overlap, needs a lock.
  using PanopticPtr = boost::shared_ptr<const PanopticCloud>;

  void onInit() override
  {
    auto& nh = getPrivateNodeHandle();
    try
    {
      applyParameters(config_, readParameters(nh, describeParameters(config_)));
      config_.organizer.labels = config_.labeller.labels == "field";
      labeller_ = std::make_unique<ScanLabeller>(config_.labeller);
      organizer_ = std::make_unique<Organizer>(config_.organizer);
      original_labeller_ = std::make_unique<OriginalLabeller>(labeller_->classTable());
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      throw;
    }
    matcher_ = std::make_unique<LabelMatcher>(config_.matcher);
    history_ = std::make_unique<FrameHistory>(static_cast<std::size_t>(config_.kept_frames));
    diagnostics_.start(getNodeHandle(), nh, getName());

    // connect() may run in the manager's thread as soon as advertise() is under way: keep it out until both are there
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const ros::SubscriberStatusCallback status = [this](const ros::SingleSubscriberPublisher&) { connect(); };
    output_ = nh.advertise<LabelledCloud>("output", 1, status, status);
    original_ = nh.advertise<sensor_msgs::PointCloud2>("output_original", 1, status, status);
    unlabelled_.advertise(nh, status);
  }

  void connect()
  {
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    if (closed_) return;
    auto& nh = getPrivateNodeHandle();
    const bool original = original_.getNumSubscribers() > 0;
    if (!original)
      panoptic_.shutdown();
    else if (!panoptic_)
      panoptic_ = subscribeChecked<PanopticCloud>(
          nh, "panoptic", kQueue, [this](const PanopticPtr& cloud) { carryBack(*cloud); },
          [this](const std::string& error) { refuse(error); });

    const bool labelled = labelledIsWanted();
    if (!labelled) labels_.shutdown();
    if (!labelled && !unlabelled_.wanted())
    {
      input_.shutdown();
      return;
    }
    const auto queue = config_.labeller.separate() ? static_cast<std::uint32_t>(config_.matcher.queue_size) : kQueue;
    const auto hints = ros::TransportHints().tcpNoDelay();
    if (labelled && !labels_ && config_.labeller.labels == "image")
      labels_ = nh.subscribe("label_input", queue, &OrganizerNodelet::receiveImage, this, hints);
    if (labelled && !labels_ && config_.labeller.labels == "cloud")
      labels_ = nh.subscribe("label_input", queue, &OrganizerNodelet::receiveLabelCloud, this, hints);
    if (!input_) input_ = nh.subscribe("input", queue, &OrganizerNodelet::receive, this, hints);
  }

  bool labelledIsWanted() const { return output_.getNumSubscribers() > 0 || original_.getNumSubscribers() > 0; }

  void receive(const sensor_msgs::PointCloud2ConstPtr& cloud)
  {
    if (!config_.labeller.separate()) return process(cloud, LabelPart());
    if (!unlabelled_.wanted())
      history_->forgetEarly();
    else if (!organizeEarly(cloud))
      return;
    if (labelledIsWanted()) match(matcher_->addCloud(cloud));
  }

  /// For those who make its labels. It is kept for them, so that they fit what was seen.
  bool organizeEarly(const sensor_msgs::PointCloud2ConstPtr& message)
  {
    FrameHistory::FramePtr frame = history_->make();
    if (!attempt("input", [&] { organize(*message, *frame); }))
    {
      history_->recycle(std::move(frame));
      return false;
    }
    frame->message = message;
    const bool labelled = labelledIsWanted();
    if (!labelled) diagnostics_.processed({{"organize", frame->organize_ms}});
    history_->keepEarly(std::move(frame), labelled ? static_cast<std::size_t>(config_.matcher.queue_size) + 1 : 0);
    return true;
  }

  void receiveImage(const sensor_msgs::ImageConstPtr& image)
  {
    match(matcher_->addLabels(image->header, {nullptr, image}));
  }

  void receiveLabelCloud(const sensor_msgs::PointCloud2ConstPtr& cloud)
  {
    match(matcher_->addLabels(cloud->header, {cloud, nullptr}));
  }

  void match(const std::optional<LabelMatcher::Pair>& pair)
  {
    if (pair) process(pair->first.cloud, pair->second);
    if (const std::uint64_t dropped = matcher_->takeDropped())
    {
      const auto& nh = getPrivateNodeHandle();
      const std::string reason =
          "cloud on " + nh.resolveName("input") + " dropped: " + matcher_->describeLack(nh.resolveName("label_input"));
      if (diagnostics_.lacking(dropped, reason)) NODELET_WARN("%s", reason.c_str());
    }
    diagnostics_.setFigure("scans waiting for labels", matcher_->waiting());
    diagnostics_.setFigure("labels without scan", matcher_->labelsWithoutCloud());
  }

  void process(const sensor_msgs::PointCloud2ConstPtr& message, const LabelPart& labels)
  {
    const bool original = original_.getNumSubscribers() > 0;
    if (!original) history_->clear();
    FrameHistory::FramePtr frame = history_->takeEarly(message);
    const auto work = [&]
    {
      if (!frame->message) organize(*message, *frame);
      if (!labelledIsWanted()) return diagnostics_.processed({{"organize", frame->organize_ms}});
      const auto start = Clock::now();
      label(viewOf(*message), labels, original, frame->scan);
      const double label_ms = millisecondsSince(start);
      publish(message->header, frame->scan);
      diagnostics_.processed({{"organize", frame->organize_ms}, {"label", label_ms}});
      warn(labeller_->doubt());
      frame->message = message;
      frame->stamp = microseconds(message->header);
    };
    if (attempt("input", work) && original)
      history_->keep(std::move(frame));
    else
      history_->recycle(std::move(frame));
  }

  /// Does something with a cloud that came on `topic`; a cloud that cannot be used is dropped, and that is said.
  template <class Work>
  bool attempt(const char* topic, Work work)
  {
    try
    {
      work();
      return true;
    }
    catch (const std::exception& error)
    {
      refuse("cloud on " + getPrivateNodeHandle().resolveName(topic) + " dropped: " + error.what());
      return false;
    }
  }

  using Clock = std::chrono::steady_clock;
  static double millisecondsSince(Clock::time_point start)
  {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }

  void organize(const sensor_msgs::PointCloud2& message, OrganizedFrame& frame)
  {
    const auto start = Clock::now();
    organizer_->organize(viewOf(message), frame.scan);
    frame.organize_ms = millisecondsSince(start);
    unlabelled_.publish(message.header, frame.scan.image.cloud);
  }

  void label(const RawCloud& raw, const LabelPart& labels, bool all_points, OrganizedScan& scan)
  {
    if (config_.labeller.labels == "none")
      labeller_->takeGeometry(scan, all_points);
    else if (!config_.labeller.separate())
      labeller_->takeOwn(scan);
    else
      takeSeparate(raw, labels, scan);
  }

  /// Once, and in the diagnostics for as long as it holds.
  void warn(const std::string& doubt)
  {
    if (doubt == doubt_) return;
    doubt_ = doubt;
    diagnostics_.setWarning(doubt);
    if (!doubt.empty()) NODELET_WARN("%s", doubt.c_str());
  }

  void takeSeparate(const RawCloud& raw, const LabelPart& labels, OrganizedScan& scan)
  {
    try
    {
      if (labels.image)
        labeller_->takeImage(viewOf(*labels.image), scan);
      else
        labeller_->takeCloud(viewOf(*labels.cloud), config_.organizer.label_field, raw, scan);
    }
    catch (const std::invalid_argument& error)
    {
      throw std::invalid_argument("labels on " + getPrivateNodeHandle().resolveName("label_input") + ": " +
                                  error.what());
    }
  }

  /// The image itself goes out, by pointer; its size is what carryBack() needs of it.
  void publish(const std_msgs::Header& header, OrganizedScan& scan)
  {
    const LabelledCloud::Ptr cloud(new LabelledCloud);
    cloud->swap(scan.image.cloud);
    scan.image.cloud.width = cloud->width, scan.image.cloud.height = cloud->height;
    pcl_conversions::toPCL(header, cloud->header);
    output_.publish(pcl::ros_ptr(cloud));
  }

  void carryBack(const PanopticCloud& panoptic)
  {
    FrameHistory::FramePtr frame = history_->take(panoptic.header.stamp);
    if (!frame)
    {
      diagnostics_.setFigure("instances without scan", ++without_scan_);
      return;
    }
    attempt("panoptic",
            [&]
            {
              original_labeller_->carryBack(frame->scan, panoptic, label_, instance_);
              publishOriginal(*frame->message);
            });
    history_->recycle(std::move(frame));
  }

  void publishOriginal(const sensor_msgs::PointCloud2& sent)
  {
    addLabels(viewOf(sent), label_, instance_, labelled_,
              config_.float_fields ? AddedType::kFloat32 : AddedType::kUint32);
    original_.publish(toMessage(labelled_, sent));
  }

  void refuse(const std::string& error)
  {
    if (diagnostics_.refused(error)) NODELET_ERROR("%s", error.c_str());
  }

  static constexpr std::uint32_t kQueue = 2;

  OrganizerNodeletConfig config_;
  std::unique_ptr<Organizer> organizer_;
  std::unique_ptr<ScanLabeller> labeller_;
  std::unique_ptr<OriginalLabeller> original_labeller_;
  std::unique_ptr<LabelMatcher> matcher_;
  std::unique_ptr<FrameHistory> history_;
  std::vector<std::uint32_t> label_, instance_;  ///< by sent point
  OriginalCloud labelled_;
  std::uint64_t without_scan_ = 0;
  std::string doubt_;
  StreamDiagnostics diagnostics_;

  std::mutex connect_mutex_;
  bool closed_ = false;
  ros::Publisher output_, original_;
  UnlabelledOutputs unlabelled_;
  ros::Subscriber input_, labels_, panoptic_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::OrganizerNodelet, nodelet::Nodelet)
