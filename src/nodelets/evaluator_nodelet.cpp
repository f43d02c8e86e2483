#include "core/plain_numbers.h"
#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/evaluation/object_errors.h"
#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"
#include "lidar_panoptic_clustering/evaluation/temporal_quality.h"
#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"
#include "ros/stamp_matcher.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <nodelet/nodelet.h>
#include <std_msgs/Float64.h>
#include <std_srvs/Empty.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct EvaluatorConfig
{
  int min_points = 50;  ///< unmatched segments with fewer points do not count
  int queue_size = 10;  ///< clouds of either kind that wait for the other; each is a scan in memory

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("min_points", self.min_points, 0, 100000);
    visitor("queue_size", self.queue_size, 1, 1000);
  }
};
}  // namespace

/// Compares ~input, a cluster nodelet's output, with ~ground_truth of player or simulator: same pixels, same stamp.
///
/// With each pair it publishes the panoptic quality over all pairs since the start or the last call of ~reset
/// (std_srvs/Empty), as std_msgs/Float64 from 0 to 1 for rqt_plot: ~pq, ~rq, ~sq, ~pq_things (mean over all thing
/// classes) and ~pq_things_present (over those that occur); likewise whether ids stay with an object, ~lstq, ~s_assoc
/// and ~s_cls, which are of use where ~input is a tracker's output; and on /diagnostics these, the objects split,
/// merged and missed, id switches, and the clouds that found no partner. All pairs are one sequence there: what is
/// played again is the same objects with other ids, so ~reset at each beginning. Memory grows with the ids. It looks at
/// the pixels only: returns hidden in the range image do not count. Rules: see PanopticQuality; ids of one class (10
/// and 252) are one class of prediction, as in a label file.
///
/// Parameters: ~class_table, and those of EvaluatorConfig.
class EvaluatorNodelet : public nodelet::Nodelet
{
public:
  ~EvaluatorNodelet() override
  {
    timer_.stop();
    reset_.shutdown();
    input_.shutdown();
    ground_truth_.shutdown();
  }

private:
  using CloudPtr = boost::shared_ptr<const PanopticCloud>;

  template <class Figures>
  struct Figure
  {
    const char* name;
    double Figures::*value;
    ros::Publisher publisher;

    void publish(const Figures& figures) const
    {
      std_msgs::Float64 message;
      message.data = figures.*value;
      publisher.publish(message);
    }
  };

  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    auto& nh = getPrivateNodeHandle();
    try
    {
      warnOfUnusedParameters(nh, namesOf(describeParameters(config_), {"class_table"}));
      applyParameters(config_, readParameters(nh, describeParameters(config_)));
      table_ =
          std::make_shared<const ClassTable>(ClassTable::load(nh.param<std::string>("class_table", "semantic_kitti")));
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    matcher_ = std::make_unique<StampMatcher<CloudPtr>>(static_cast<std::size_t>(config_.queue_size));
    startAgain();
    for (auto& figure : figures_) figure.publisher = advertiseAlone<std_msgs::Float64>(nh, figure.name, 10);
    for (auto& figure : over_time_) figure.publisher = advertiseAlone<std_msgs::Float64>(nh, figure.name, 10);

    {
      const std::lock_guard<std::mutex> lock(linkMutex());
      updater_ = std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), nh, getName());
    }
    updater_->setHardwareID("none");
    updater_->add("panoptic quality", this, &EvaluatorNodelet::report);
    timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { updater_->update(); });
    reset_ = nh.advertiseService("reset", &EvaluatorNodelet::reset, this);

    const auto queue_size = static_cast<std::uint32_t>(config_.queue_size);
    const auto on_error = [this](const std::string& error) { refuse(error); };
    input_ = subscribeChecked<PanopticCloud>(
        nh, "input", queue_size, [this](const CloudPtr& cloud) { receive(cloud, &StampMatcher<CloudPtr>::addLeft); },
        on_error);
    ground_truth_ = subscribeChecked<PanopticCloud>(
        nh, "ground_truth", queue_size,
        [this](const CloudPtr& cloud) { receive(cloud, &StampMatcher<CloudPtr>::addRight); }, on_error);
  }

  using Add = std::optional<StampMatcher<CloudPtr>::Pair> (StampMatcher<CloudPtr>::*)(std::uint64_t, CloudPtr);

  void receive(const CloudPtr& cloud, Add add)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto pair = ((*matcher_).*add)(cloud->header.stamp, cloud);
    if (!pair) return;
    try
    {
      evaluate(*pair->first, *pair->second);
    }
    catch (const std::exception& error)
    {
      note(std::string("scan not evaluated: ") + error.what());
    }
  }

  void evaluate(const PanopticCloud& predicted, const PanopticCloud& truth)
  {
    const auto size = [](const PanopticCloud& cloud)
    { return std::to_string(cloud.width) + " x " + std::to_string(cloud.height); };
    if (predicted.width != truth.width || predicted.height != truth.height || predicted.size() != truth.size())
      throw std::invalid_argument("expected a cloud of the ground truth's " + size(truth) + " points, found " +
                                  size(predicted));
    predicted_.copy(predicted, *table_, true);
    truth_.copy(truth, *table_, false);
    quality_->addScan(predicted_.view(), truth_.view(), truth.size());
    for (const TrueObject& object : errors_.judge(quality_->lastScan())) objects_.add(object.outcome);

    temporal_->addScan("", quality_->lastScan());
    switches_->addScan(quality_->lastScan());

    const PanopticFigures values = quality_->figures();
    for (const auto& figure : figures_) figure.publish(values);
    const TemporalFigures over_time = temporal_->figures();
    for (const auto& figure : over_time_) figure.publish(over_time);
  }

  void refuse(const std::string& error)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    note(error);
  }

  /// Not by a throttled macro: its clock is a static that several evaluators would race for.
  void note(const std::string& error)
  {
    ++refused_;
    last_error_ = error;
    const auto now = ros::WallTime::now();
    if (now - last_logged_ < ros::WallDuration(5.0)) return;
    last_logged_ = now;
    NODELET_ERROR("%s", error.c_str());
  }

  bool reset(std_srvs::Empty::Request&, std_srvs::Empty::Response&)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    startAgain();
    return true;
  }

  void startAgain()
  {
    quality_ = std::make_unique<PanopticQuality>(table_, config_.min_points);
    temporal_ = std::make_unique<TemporalQuality>(table_, config_.min_points);
    switches_ = std::make_unique<IdSwitches>(config_.min_points);
    errors_ = ObjectErrors(config_.min_points);
    objects_ = {};
    matcher_->reset();
    refused_ = 0;
    last_error_.clear();
  }

  void report(diagnostic_updater::DiagnosticStatusWrapper& status)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    using Level = diagnostic_msgs::DiagnosticStatus;
    if (refused_ > 0)
      status.summary(Level::WARN, "clouds refused: " + last_error_);
    else
      status.summary(Level::OK, quality_->scanCount() > 0 ? "evaluating" : "no pair of clouds yet");
    const PanopticFigures values = quality_->figures();
    const PlainNumbers plain;
    for (const auto& figure : figures_) status.addf(figure.name, "%.4f", values.*figure.value);
    const TemporalFigures over_time = temporal_->figures();
    for (const auto& figure : over_time_) status.addf(figure.name, "%.4f", over_time.*figure.value);
    status.add("id switches", std::to_string(switches_->count()));
    status.add("scans evaluated", std::to_string(quality_->scanCount()));
    status.add("true objects", std::to_string(objects_.total()));
    status.add("true objects split", std::to_string(objects_.split));
    status.add("true objects merged", std::to_string(objects_.merged));
    status.add("true objects missed", std::to_string(objects_.missed));
    status.add("predictions without ground truth", std::to_string(matcher_->unmatchedLeft()));
    status.add("ground truths without prediction", std::to_string(matcher_->unmatchedRight()));
    status.add("clouds refused", std::to_string(refused_));
  }

  /// Class ids and instances of a cloud's pixels.
  struct Labels
  {
    std::vector<std::uint32_t> class_ids, instances;

    /// With `canonical` all ids of a class become its first one, as in prediction files; an object whose points have
    /// several is one then.
    void copy(const PanopticCloud& cloud, const ClassTable& table, bool canonical)
    {
      class_ids.resize(cloud.size()), instances.resize(cloud.size());
      for (std::size_t i = 0; i < cloud.size(); ++i)
      {
        const PanopticPoint& point = cloud.points[i];
        const auto& ids = table[table.find(point.label)].ids;
        class_ids[i] = canonical && !ids.empty() ? ids.front() : point.label;
        instances[i] = point.instance;
      }
    }
    ScanLabels view() const { return ScanLabels::separate(class_ids.data(), instances.data()); }
  };

  EvaluatorConfig config_;
  std::shared_ptr<const ClassTable> table_;

  std::mutex mutex_;                                 ///< callbacks may come in several threads, the service's for one
  std::unique_ptr<StampMatcher<CloudPtr>> matcher_;  ///< left: input, right: ground truth
  std::unique_ptr<PanopticQuality> quality_;
  std::unique_ptr<TemporalQuality> temporal_;
  std::unique_ptr<IdSwitches> switches_;
  ObjectErrors errors_;
  ObjectErrorCounts objects_;
  Labels predicted_, truth_;
  std::uint64_t refused_ = 0;
  std::string last_error_;
  ros::WallTime last_logged_;

  Figure<PanopticFigures> figures_[5] = {{"pq", &PanopticFigures::pq, {}},
                                         {"rq", &PanopticFigures::rq, {}},
                                         {"sq", &PanopticFigures::sq, {}},
                                         {"pq_things", &PanopticFigures::pq_th, {}},
                                         {"pq_things_present", &PanopticFigures::pq_th_present, {}}};
  Figure<TemporalFigures> over_time_[3] = {{"lstq", &TemporalFigures::lstq, {}},
                                           {"s_assoc", &TemporalFigures::s_assoc, {}},
                                           {"s_cls", &TemporalFigures::s_cls, {}}};
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
  ros::ServiceServer reset_;
  ros::Subscriber input_, ground_truth_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::EvaluatorNodelet, nodelet::Nodelet)
