#include "ros/cluster_nodelet.h"

#include "reporting/stage_message.h"
#include "ros/object_list.h"
#include "ros/parameter_server.h"

#include <pcl_conversions/pcl_conversions.h>

#include <utility>

namespace lidar_panoptic_clustering
{
ClusterNodelet::Work ClusterNodelet::load()
{
  auto& nh = getPrivateNodeHandle();
  // the raw parameters first: the dynamic_reconfigure server clamps what is out of range without a word
  const ParameterMap parameters = readParameters(nh, algorithmParameters(algorithm_));
  Algorithm algorithm = makeAlgorithm(algorithm_, parameters);
  const auto table = loadClassTable();

  std::vector<std::string> of_others;
  for (const std::string& other : algorithmNames()) of_others = namesOf(algorithmParameters(other), of_others);
  diagnostics_.setWarning(
      "parameters", warnOfUnusedParameters(nh, namesOf(algorithmParameters(algorithm_), {kClassTable}), of_others));
  pipeline_ = std::make_unique<FramePipeline>(table, algorithm.pipeline, std::move(algorithm.clusterer));
  startReconfigure();
  return [this](const Scan& scan) { process(scan); };
}

void ClusterNodelet::advertiseMore()
{
  stages_ = advertiseAlone<diagnostic_msgs::DiagnosticArray>(getPrivateNodeHandle(), "stages", 10);
}

void ClusterNodelet::stop()
{
  stopReconfigure();
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

void ClusterNodelet::process(const Scan& scan)
{
  const LabelledCloud& cloud = *scan.cloud;
  {
    const std::lock_guard<std::mutex> lock(pending_mutex_);
    // taken out first: one that is refused is not tried again, with half of it gone
    if (auto pending = std::exchange(pending_, std::nullopt))
      pipeline_->reconfigure(pending->pipeline, std::move(pending->clusterer));
  }

  if (wantsCloud())
  {
    const PanopticCloud::Ptr out = pool_.take();
    pipeline_->process(cloud, *out);
    output_.publish(pcl::ros_ptr(out));
  }
  else
  {
    pipeline_->segment(cloud);
  }
  if (wantsObjects()) publishObjects(cloud.header);
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
  if (wantsMarkers()) markers_.publish(marker_list_.update(*list, pipeline_->colors(), ros::Time::now()));
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
