#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "nodelets/cloud_subscription.h"
#include "nodelets/parameter_server.h"
#include "nodelets/stream_diagnostics.h"

#include <nodelet/nodelet.h>
#include <pcl_conversions/pcl_conversions.h>
#include <pluginlib/class_list_macros.hpp>

#include <boost/make_shared.hpp>
#include <memory>
#include <mutex>

namespace lidar_panoptic_clustering
{
/// ~input sensor_msgs/PointCloud2 as a driver publishes it, organised either way -> ~output organised LabelledCloud.
///
/// Both go by pointer inside a nodelet manager. Subscribes only while someone listens to ~output. A cloud that cannot
/// be used is dropped, logged and shown in the diagnostics; the next one is looked at afresh.
///
/// Parameters: those of OrganizerConfig.
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
    output_.shutdown();
  }

private:
  void onInit() override
  {
    auto& nh = getPrivateNodeHandle();
    try
    {
      OrganizerConfig config;
      applyParameters(config, readParameters(nh, describeParameters(config)));
      organizer_ = std::make_unique<Organizer>(config);
    }
    catch (const std::exception& error)
    {
      NODELET_FATAL("not loaded: %s", error.what());
      throw;
    }
    diagnostics_.start(getNodeHandle(), nh, getName());

    // connect() may run in the manager's thread as soon as advertise() is under way: keep it out until output_ is set
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const ros::SubscriberStatusCallback status = [this](const ros::SingleSubscriberPublisher&) { connect(); };
    output_ = nh.advertise<LabelledCloud>("output", 1, status, status);
  }

  void connect()
  {
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    if (closed_) return;
    if (output_.getNumSubscribers() == 0)
      input_.shutdown();
    else if (!input_)
      input_ = getPrivateNodeHandle().subscribe("input", 2, &OrganizerNodelet::receive, this,
                                                ros::TransportHints().tcpNoDelay());
  }

  void receive(const sensor_msgs::PointCloud2ConstPtr& message)
  {
    try
    {
      const auto scan = boost::make_shared<OrganizedScan>();
      organizer_->organize(viewOf(*message), *scan);
      pcl_conversions::toPCL(message->header, scan->image.cloud.header);
      output_.publish(boost::shared_ptr<LabelledCloud>(scan, &scan->image.cloud));
      diagnostics_.processed();
    }
    catch (const std::exception& error)
    {
      const std::string text = "cloud on " + getPrivateNodeHandle().resolveName("input") + " dropped: " + error.what();
      if (diagnostics_.refused(text)) NODELET_ERROR("%s", text.c_str());
    }
  }

  std::unique_ptr<Organizer> organizer_;
  StreamDiagnostics diagnostics_;

  std::mutex connect_mutex_;
  bool closed_ = false;
  ros::Publisher output_;
  ros::Subscriber input_;
};
}  // namespace lidar_panoptic_clustering

PLUGINLIB_EXPORT_CLASS(lidar_panoptic_clustering::OrganizerNodelet, nodelet::Nodelet)
