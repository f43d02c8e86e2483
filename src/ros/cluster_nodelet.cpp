#include "ros/cluster_nodelet.h"

#include "reporting/stage_message.h"
#include "ros/cloud_subscription.h"
#include "ros/load_failure.h"
#include "ros/object_list.h"
#include "ros/open_queue.h"
#include "ros/parameter_server.h"

#include <pcl_conversions/pcl_conversions.h>

#include <utility>

namespace lidar_panoptic_clustering
{
void ClusterNodelet::onInit()
{
  openQueue(getPrivateNodeHandle());
  try
  {
    load();
    thread_ = std::thread(&ClusterNodelet::work, this);
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
      [this](const CloudPtr& cloud) { mailbox_.put(cloud); });
  advertise();
  // who listens already need not wait for the manager to tell of it
  connect();
}

void ClusterNodelet::load()
{
  auto& nh = getPrivateNodeHandle();
  // the raw parameters first: the dynamic_reconfigure server clamps what is out of range without a word
  const ParameterMap parameters = readParameters(nh, algorithmParameters(algorithm_));
  Algorithm algorithm = makeAlgorithm(algorithm_, parameters);
  const ParameterInfo table_info{"class_table", std::string("semantic_kitti"), 0.0, 0.0, {}};
  const ParameterMap given_table = readParameters(nh, {table_info});
  const auto table_name = std::get<std::string>(given_table.empty() ? table_info.value : given_table.at("class_table"));
  const auto table = std::make_shared<const ClassTable>(ClassTable::load(table_name));

  std::vector<std::string> of_others;
  for (const std::string& other : algorithmNames()) of_others = namesOf(algorithmParameters(other), of_others);
  diagnostics_.setWarning(
      "parameters", warnOfUnusedParameters(nh, namesOf(algorithmParameters(algorithm_), {table_info.name}), of_others));
  pipeline_ = std::make_unique<FramePipeline>(table, algorithm.pipeline, std::move(algorithm.clusterer));
  startReconfigure();
}

void ClusterNodelet::advertise()
{
  // connect() may run in the manager's thread as soon as advertise() is under way: keep it out until both are there
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  const ros::SubscriberStatusCallback status = [this](const ros::SingleSubscriberPublisher&) { connect(); };
  auto& nh = getPrivateNodeHandle();
  output_ = advertiseAlone<PanopticCloud>(nh, "output", 1, status, status);
  markers_ = advertiseAlone<visualization_msgs::MarkerArray>(nh, "markers", 1, status, status);
  objects_.advertise(nh, status);
  stages_ = advertiseAlone<diagnostic_msgs::DiagnosticArray>(nh, "stages", 10);
}

void ClusterNodelet::shutdown()
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
  stopReconfigure();
  input_.shutdown();
  output_.shutdown();
  markers_.shutdown();
  objects_.shutdown();
  stages_.shutdown();
}

void ClusterNodelet::reconfigure(const dynamic_reconfigure::Config& message)
{
  ParameterMap parameters;
  for (const auto& p : message.bools) parameters[p.name] = static_cast<bool>(p.value);
  for (const auto& p : message.ints) parameters[p.name] = p.value;
  for (const auto& p : message.doubles) parameters[p.name] = p.value;
  for (const auto& p : message.strs) parameters[p.name] = p.value;
  Algorithm algorithm = makeAlgorithm(algorithm_, parameters);
  const std::lock_guard<std::mutex> lock(pending_mutex_);
  pending_ = std::move(algorithm);
}

void ClusterNodelet::connect()
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
    input_ = subscribeChecked<LabelledCloud>(
        getPrivateNodeHandle(), "input", 1,
        [this](const CloudPtr& cloud, const Arrival& arrival)
        {
          latched_.received(cloud, arrival.latched);
          if (mailbox_.put(cloud)) diagnostics_.overwritten();
        },
        [this](const std::string& error) { refuse(error); });
  }
}

Idle ClusterNodelet::describeIdle()
{
  const std::lock_guard<std::mutex> lock(connect_mutex_);
  return lidar_panoptic_clustering::describeIdle(
      listeners(), output_.getTopic() + ", " + markers_.getTopic() + " or " + objects_.topic(), input_);
}

void ClusterNodelet::refuse(const std::string& error)
{
  if (diagnostics_.refused(error)) NODELET_ERROR("%s", error.c_str());
}

void ClusterNodelet::work()
{
  while (const auto cloud = mailbox_.take())
  {
    try
    {
      process(**cloud);
    }
    catch (const std::exception& error)
    {
      refuse("cloud on " + getPrivateNodeHandle().resolveName("input") + " dropped: " + error.what());
    }
  }
}

void ClusterNodelet::process(const LabelledCloud& cloud)
{
  {
    const std::lock_guard<std::mutex> lock(pending_mutex_);
    // taken out first: one that is refused is not tried again, with half of it gone
    if (auto pending = std::exchange(pending_, std::nullopt))
      pipeline_->reconfigure(pending->pipeline, std::move(pending->clusterer));
  }

  if (output_.getNumSubscribers() > 0)
  {
    const PanopticCloud::Ptr out = pool_.take();
    pipeline_->process(cloud, *out);
    output_.publish(pcl::ros_ptr(out));
  }
  else
  {
    pipeline_->segment(cloud);
  }
  if (markers_.getNumSubscribers() + objects_.listeners() > 0) publishObjects(cloud.header);
  const StageTimes& times = pipeline_->times();
  const StreamDiagnostics::StageMilliseconds stages = {{"select", times.select_ms},
                                                       {"cluster", times.cluster_ms},
                                                       {"refine", times.refine_ms},
                                                       {"paint", times.paint_ms}};
  diagnostics_.processed(stages);
  if (stages_.getNumSubscribers() > 0) publishStages(cloud.header, stages);
  warnOfUnknownLabels();
}

void ClusterNodelet::publishObjects(const pcl::PCLHeader& header)
{
  const auto& boxes = boxes_.fit(pipeline_->things(), pipeline_->instances());
  const auto list = listObjects(pcl_conversions::fromPCL(header), pipeline_->table(), pipeline_->things(),
                                pipeline_->instances(), boxes);
  objects_.publish(list);
  if (markers_.getNumSubscribers() > 0)
    markers_.publish(marker_list_.update(*list, pipeline_->colors(), ros::Time::now()));
}

void ClusterNodelet::publishStages(const pcl::PCLHeader& header, const StreamDiagnostics::StageMilliseconds& stages)
{
  const auto array = boost::make_shared<diagnostic_msgs::DiagnosticArray>();
  array->header = pcl_conversions::fromPCL(header);
  array->status.push_back(
      stageMessage(getName(), algorithm_, pipeline_->things().size(), pipeline_->instances().count(), stages));
  stages_.publish(array);
}

void ClusterNodelet::warnOfUnknownLabels()
{
  constexpr std::size_t kMostWarnings = 100;  // a field of noise is not worth more lines
  for (const std::uint32_t label : pipeline_->things().unknown_labels)
    if (warned_labels_.size() < kMostWarnings && warned_labels_.insert(label).second)
      NODELET_WARN("class id %u is not in the class table '%s': its points are treated as not a thing", label,
                   pipeline_->table().name().c_str());
}
}  // namespace lidar_panoptic_clustering
