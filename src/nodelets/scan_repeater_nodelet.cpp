#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/core/point_types.h"
#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
struct RepeaterConfig
{
  double rate_hz = 10.0;
  int scans = 10;  ///< to collect; each is kept in memory

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    visitor("rate_hz", self.rate_hz, 0.01, 1000.0);
    visitor("scans", self.scans, 1, 1000);
  }
};
}  // namespace

/// Collects the first scans of ~input (LabelledCloud), and publishes them on ~output over and over, as a driver would:
/// at a steady rate, each in a cloud just written, and stamped right before it is published.
///
/// A source for measurements in a graph: simulating a scan, or reading and projecting one, takes more processor time
/// than to cluster it. Once it has its scans it listens no more; it publishes while someone listens.
///
/// Parameters: those of RepeaterConfig.
class ScanRepeaterNodelet : public nodelet::Nodelet
{
public:
  ~ScanRepeaterNodelet() override
  {
    timer_.stop();
    input_.shutdown();
  }

private:
  using CloudPtr = boost::shared_ptr<const LabelledCloud>;

  void onInit() override
  {
    openQueue(getPrivateNodeHandle());
    auto& nh = getPrivateNodeHandle();
    try
    {
      warnOfUnusedParameters(nh, namesOf(describeParameters(config_)));
      applyParameters(config_, readParameters(nh, describeParameters(config_)));
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      announceLoadFailure(getName(), error.what());
      throw;
    }
    output_ = advertiseAlone<LabelledCloud>(nh, "output", kQueue);
    // timer and input share the nodelet's queue: one callback at a time
    input_ = subscribeChecked<LabelledCloud>(
        nh, "input", kQueue, [this](const CloudPtr& cloud) { collect(cloud); },
        [this](const std::string& error) { NODELET_ERROR("%s", error.c_str()); });
    timer_ =
        nh.createWallTimer(ros::WallDuration(1.0 / config_.rate_hz), [this](const ros::WallTimerEvent&) { repeat(); });
  }

  bool hasAll() const { return scans_.size() == static_cast<std::size_t>(config_.scans); }

  void collect(const CloudPtr& cloud)
  {
    if (hasAll()) return;
    scans_.push_back(cloud);
    if (hasAll()) NODELET_INFO("repeats %zu scans from now on, at %g Hz", scans_.size(), config_.rate_hz);
  }

  void repeat()
  {
    if (!hasAll()) return;
    if (input_) input_.shutdown();
    if (output_.getNumSubscribers() == 0) return;
    const LabelledCloud::Ptr cloud(new LabelledCloud(*scans_[next_]));
    next_ = (next_ + 1) % scans_.size();
    std::uint64_t now = 0;
    pcl_conversions::toPCL(ros::Time::now(), now);
    last_stamp_ = std::max(now, last_stamp_ + 1);
    cloud->header.stamp = last_stamp_;
    output_.publish(pcl::ros_ptr(cloud));
  }

  static constexpr std::uint32_t kQueue = 10;

  RepeaterConfig config_;
  std::vector<CloudPtr> scans_;
  std::size_t next_ = 0;
  std::uint64_t last_stamp_ = 0;

  ros::Publisher output_;
  ros::Subscriber input_;
  ros::WallTimer timer_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::ScanRepeaterNodelet, nodelet::Nodelet)
