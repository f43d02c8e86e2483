#include "ros/object_nodelet.h"

#include "ros/load_failure.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <visualization_msgs/MarkerArray.h>

namespace lidar_panoptic_clustering
{
template <class Cloud>
void ObjectNodelet<Cloud>::onInit()
{
  openQueue(getPrivateNodeHandle());
  try
  {
    thread_ = std::thread([this, work = load()] { run(work); });
  }
  catch (const std::exception& error)
  {
    NODELET_FATAL("not loaded: %s", error.what());
    announceLoadFailure(getName(), error.what());
    throw;
  }
  diagnostics_.start(getNodeHandle(), getPrivateNodeHandle(), getName(), [this] { return describeIdle(); });
  latched_.start(
      getPrivateNodeHandle(),
      [this]
      {
        const std::lock_guard<std::mutex> lock(connect_mutex_);
        return input_.getNumPublishers() > 0;
      },
      [this](const CloudPtr& cloud) { receive(cloud); });
  advertise();
  // who listens already need not wait for the manager to tell of it
  connect();
}

template <class Cloud>
std::shared_ptr<const ClassTable> ObjectNodelet<Cloud>::loadClassTable()
{
  const ParameterInfo info{kClassTable, std::string("semantic_kitti"), 0.0, 0.0, {}};
  const ParameterMap given = readParameters(getPrivateNodeHandle(), {info});
  return std::make_shared<const ClassTable>(
      ClassTable::load(std::get<std::string>(given.empty() ? info.value : given.at(kClassTable))));
}

template <class Cloud>
void ObjectNodelet<Cloud>::advertise()
{
  // connect() may run in the manager's thread as soon as advertise() is under way: keep it out until all are there
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  const ros::SubscriberStatusCallback status = [this](const ros::SingleSubscriberPublisher&) { connect(); };
  auto& nh = getPrivateNodeHandle();
  output_ = advertiseAlone<PanopticCloud>(nh, "output", 1, status, status);
  markers_ = advertiseAlone<visualization_msgs::MarkerArray>(nh, "markers", 1, status, status);
  objects_.advertise(nh, status);
  advertiseMore();
}

template <class Cloud>
void ObjectNodelet<Cloud>::shutdown()
{
  {
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    closed_ = true;
  }
  mailbox_.close();
  if (thread_.joinable()) thread_.join();
  // each of these waits for its callback under way; without the lock, which connect() may be waiting for
  diagnostics_.stop();
  latched_.stop();
  stop();
  input_.shutdown();
  output_.shutdown();
  markers_.shutdown();
  objects_.shutdown();
}

template <class Cloud>
void ObjectNodelet<Cloud>::connect()
{
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  if (closed_) return;
  if (listeners() == 0)
  {
    input_.shutdown();
    latched_.forget();
  }
  else if (!input_)
  {
    diagnostics_.expectScans();
    input_ = subscribeChecked<Cloud>(
        getPrivateNodeHandle(), "input", 1,
        [this](const CloudPtr& cloud, const Arrival& arrival)
        {
          diagnostics_.setText("input", describe(arrival));
          latched_.received(cloud, arrival.latched);
          if (receive(cloud)) diagnostics_.overwritten();
        },
        [this](const std::string& error) { refuse(error); });
  }
}

/// Returns whether a scan that nobody had looked at was overwritten.
template <class Cloud>
bool ObjectNodelet<Cloud>::receive(const CloudPtr& cloud)
{
  return mailbox_.put({cloud, ros::WallTime::now(), ros::Time::now()});
}

template <class Cloud>
Idle ObjectNodelet<Cloud>::describeIdle()
{
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  return lidar_panoptic_clustering::describeIdle(
      listeners(), output_.getTopic() + ", " + markers_.getTopic() + " or " + objects_.topic(), input_);
}

template <class Cloud>
void ObjectNodelet<Cloud>::refuse(const std::string& error)
{
  if (diagnostics_.refused(error)) NODELET_ERROR("%s", error.c_str());
}

template <class Cloud>
void ObjectNodelet<Cloud>::run(const Work& work)
{
  while (const auto scan = mailbox_.take())
  {
    try
    {
      work(*scan);
    }
    catch (const std::exception& error)
    {
      refuse("cloud on " + getPrivateNodeHandle().resolveName("input") + " dropped: " + error.what());
    }
  }
}

template class ObjectNodelet<LabelledCloud>;
template class ObjectNodelet<PanopticCloud>;
}  // namespace lidar_panoptic_clustering
