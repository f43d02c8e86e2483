#include "ros/organizer_nodelet.h"

#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kQueue = 2;
}  // namespace

OrganizerNodelet::~OrganizerNodelet()
{
  {
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    closed_ = true;
  }
  // each of these waits for its callback under way; without the lock, which connect() may be waiting for
  diagnostics_.stop();
  latched_.stop();
  input_.shutdown();
  labels_.shutdown();
  panoptic_.shutdown();
  output_.shutdown();
  original_.shutdown();
  unlabelled_.shutdown();
}

void OrganizerNodelet::onInit()
{
  openQueue(getPrivateNodeHandle());
  auto& nh = getPrivateNodeHandle();
  try
  {
    diagnostics_.setWarning("parameters", warnOfUnusedParameters(nh, namesOf(describeParameters(config_))));
    applyParameters(config_, readParameters(nh, describeParameters(config_)));
    organizer_ = std::make_unique<ScanOrganizer>(config_.organizer);
  }
  catch (const std::exception& error)
  {
    NODELET_FATAL("not loaded: %s", error.what());
    announceLoadFailure(getName(), error.what());
    throw;
  }
  matcher_ = std::make_unique<LabelMatcher>(config_.matcher);
  history_ = std::make_unique<FrameHistory>(static_cast<std::size_t>(config_.kept_frames));
  diagnostics_.start(getNodeHandle(), nh, getName(), [this] { return describeIdle(); });
  latched_.start(
      nh, [this] { return isPublished(); }, [this](const CloudPtr& cloud) { repeat(cloud); });
  advertise();
  // who listens already need not wait for the manager to tell of it
  connect();
}

void OrganizerNodelet::advertise()
{
  auto& nh = getPrivateNodeHandle();
  // connect() may run in the manager's thread as soon as advertise() is under way: keep it out until all are there
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  const ros::SubscriberStatusCallback status = [this](const ros::SingleSubscriberPublisher&) { connect(); };
  output_ = advertiseAlone<LabelledCloud>(nh, "output", 1, status, status);
  original_ = advertiseAlone<sensor_msgs::PointCloud2>(nh, "output_original", 1, status, status);
  unlabelled_.advertise(nh, status);
}

void OrganizerNodelet::connect()
{
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  if (closed_) return;
  connectPanoptic();
  connectLabels();
  if (!labelledIsWanted() && !unlabelled_.wanted())
  {
    input_.shutdown();
    latched_.forget();
    latched_pair_.reset();
  }
  else if (!input_)
  {
    diagnostics_.expectScans();
    input_ = subscribeChecked<sensor_msgs::PointCloud2>(
        getPrivateNodeHandle(), "input",
        organizer_->isSeparate() ? static_cast<std::uint32_t>(config_.matcher.queue_size) : kQueue,
        [this](const CloudPtr& cloud, const Arrival& arrival)
        {
          diagnostics_.setText("input", describe(arrival));
          latched_.received(cloud, arrival.latched);
          receive(cloud);
        },
        [this](const std::string& error) { refuse(error); });
  }
}

void OrganizerNodelet::connectPanoptic()
{
  if (original_.getNumSubscribers() == 0)
    panoptic_.shutdown();
  else if (!panoptic_)
    panoptic_ = subscribeChecked<PanopticCloud>(
        getPrivateNodeHandle(), "panoptic", kQueue,
        [this](const boost::shared_ptr<const PanopticCloud>& cloud) { carryBack(*cloud); },
        [this](const std::string& error) { refuse(error); });
}

void OrganizerNodelet::connectLabels()
{
  if (!labelledIsWanted()) return labels_.shutdown();
  if (labels_ || !organizer_->isSeparate()) return;
  auto& nh = getPrivateNodeHandle();
  const auto queue = static_cast<std::uint32_t>(config_.matcher.queue_size);
  const auto on_error = [this](const std::string& error) { refuse(error); };
  if (config_.organizer.labeller.labels == "image")
    labels_ = subscribeChecked<sensor_msgs::Image>(
        nh, "label_input", queue,
        [this](const sensor_msgs::ImageConstPtr& image) {
          match(matcher_->addLabels(image->header, {nullptr, image}));
        },
        on_error);
  else
    labels_ = subscribeChecked<sensor_msgs::PointCloud2>(
        nh, "label_input", queue,
        [this](const CloudPtr& cloud) {
          match(matcher_->addLabels(cloud->header, {cloud, nullptr}));
        },
        on_error);
}

bool OrganizerNodelet::isPublished()
{
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  return input_.getNumPublishers() > 0;
}

Idle OrganizerNodelet::describeIdle()
{
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  if (matcher_->waiting() > 0)
    return {false, "no labels: scans wait for them on " + labels_.getTopic() + ", which has " +
                       std::to_string(labels_.getNumPublishers()) + " publishers"};
  const bool is_wanted = labelledIsWanted() || unlabelled_.wanted();
  return lidar_panoptic_clustering::describeIdle(
      is_wanted ? 1 : 0, output_.getTopic() + ", " + original_.getTopic() + " or ~unlabelled", input_);
}

void OrganizerNodelet::receive(const CloudPtr& cloud)
{
  if (!organizer_->isSeparate()) return process(cloud, LabelPart());
  if (!unlabelled_.wanted())
    history_->forgetEarly();
  else if (!organizeEarly(cloud))
    return;
  if (labelledIsWanted()) match(matcher_->addCloud(cloud));
}

void OrganizerNodelet::repeat(const CloudPtr& cloud)
{
  if (latched_pair_ && latched_pair_->first.cloud == cloud)
    process(cloud, latched_pair_->second);
  else if (!organizer_->isSeparate())
    process(cloud, LabelPart());
  else if (unlabelled_.wanted())
    organizeEarly(cloud);
}

bool OrganizerNodelet::organizeEarly(const CloudPtr& message)
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

void OrganizerNodelet::match(const std::optional<LabelMatcher::Pair>& pair)
{
  if (pair)
  {
    if (latched_.holds(pair->first.cloud)) latched_pair_ = pair;
    process(pair->first.cloud, pair->second);
  }
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

void OrganizerNodelet::process(const CloudPtr& message, const LabelPart& labels)
{
  const bool original = original_.getNumSubscribers() > 0;
  if (!original) history_->clear();
  FrameHistory::FramePtr frame = history_->takeEarly(message);
  const auto work = [&]
  {
    if (!frame->message) organize(*message, *frame);
    if (!labelledIsWanted()) return diagnostics_.processed({{"organize", frame->organize_ms}});
    const double label_ms = label(*message, labels, original, *frame);
    output_.publish(pcl::ros_ptr(organizer_->takeImage(message->header, frame->scan)));
    diagnostics_.processed({{"organize", frame->organize_ms}, {"label", label_ms}});
    frame->message = message;
    frame->stamp = microseconds(message->header);
  };
  if (attempt("input", work) && original)
    history_->keep(std::move(frame));
  else
    history_->recycle(std::move(frame));
}

void OrganizerNodelet::organize(const sensor_msgs::PointCloud2& message, OrganizedFrame& frame)
{
  organizer_->organize(message, frame);
  tellLayout();
  unlabelled_.publish(message.header, frame.scan.image.cloud);
}

double OrganizerNodelet::label(const sensor_msgs::PointCloud2& message, const LabelPart& labels, bool all_points,
                               OrganizedFrame& frame)
{
  try
  {
    const double milliseconds = organizer_->label(message, labels, all_points, frame);
    warn("labels", organizer_->doubt());
    tellGround();
    return milliseconds;
  }
  catch (const std::invalid_argument& error)
  {
    if (!organizer_->isSeparate()) throw;
    throw std::invalid_argument("labels on " + getPrivateNodeHandle().resolveName("label_input") + ": " + error.what());
  }
}

void OrganizerNodelet::carryBack(const PanopticCloud& panoptic)
{
  FrameHistory::FramePtr frame = history_->take(panoptic.header.stamp);
  if (!frame) return diagnostics_.setFigure("instances without scan", ++without_scan_);
  attempt("panoptic", [&] { original_.publish(organizer_->carryBack(*frame, panoptic)); });
  history_->recycle(std::move(frame));
}

template <class Work>
bool OrganizerNodelet::attempt(const char* topic, Work work)
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
}  // namespace lidar_panoptic_clustering
