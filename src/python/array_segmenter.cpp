#include "python/array_segmenter.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
struct SegmenterConfig
{
  ClassLabelsConfig labels;
  ArrayScanConfig scan;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor&& visitor)
  {
    ClassLabelsConfig::visit(self.labels, visitor);
    ArrayScanConfig::visit(self.scan, visitor);
  }
};

/// Those of the parameters that are not the config's: the algorithm's.
ParameterMap othersThan(const SegmenterConfig& config, ParameterMap parameters)
{
  for (const ParameterInfo& info : describeParameters(config)) parameters.erase(info.name);
  return parameters;
}

void requireKnown(const std::string& algorithm, const ParameterMap& parameters)
{
  const std::vector<ParameterInfo> known = segmenterParameters(algorithm);
  for (const auto& [name, value] : parameters)
    if (std::none_of(known.begin(), known.end(), [&n = name](const ParameterInfo& info) { return info.name == n; }))
      detail::throwUnknown(name, known);
}
}  // namespace

std::vector<ParameterInfo> segmenterParameters(const std::string& algorithm)
{
  std::vector<ParameterInfo> all = algorithmParameters(algorithm);
  for (ParameterInfo& info : describeParameters(SegmenterConfig())) all.push_back(std::move(info));
  return all;
}

ArraySegmenter::ArraySegmenter(const std::string& algorithm, const ParameterMap& parameters)
    : algorithm_(algorithm), parameters_(parameters)
{
  requireKnown(algorithm, parameters);
  SegmenterConfig config;
  applyKnownParameters(config, parameters);
  Algorithm made = makeAlgorithm(algorithm, othersThan(config, parameters));
  labels_ = std::make_unique<ClassLabels>(config.labels);
  scan_ = std::make_unique<ArrayScan>(config.scan);
  pipeline_ = std::make_unique<FramePipeline>(labels_->table(), made.pipeline, std::move(made.clusterer));
  hidden_points_.emplace(labels_->table());
}

void ArraySegmenter::segment(const PointsView& points, const IdsView& labels, const IdsView* ring,
                             std::uint32_t* instances, std::uint32_t* voted)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  objects_.clear(), things_.points.clear(), things_of_.id.clear();  // a scan that is refused leaves none
  labels_->read(labels, classes_);
  scan_->place(points, classes_, ring);
  pipeline_->segment(scan_->scan().image.cloud);
  carryBack();
  keepObjects(instances);
  if (voted != nullptr) vote(voted);
}

void ArraySegmenter::carryBack()
{
  pixelInstances(pipeline_->things(), pipeline_->instances(), instance_of_pixel_);
  if (scan_->isImage())
    instance_ = instance_of_pixel_;
  else
    hidden_points_->label(scan_->points(), classes_, scan_->scan().image, instance_of_pixel_, instance_);
}

void ArraySegmenter::vote(std::uint32_t* voted) const
{
  const ClassTable& table = pipeline_->table();
  const std::size_t instances = pipeline_->instances().count();  // larger ids are hidden points' own
  for (std::size_t k = 0; k < classes_.size(); ++k)
  {
    voted[k] = classes_[k];
    if (instance_[k] == 0 || instance_[k] > instances) continue;
    const ClassIndex own = table.find(classes_[k]), elected = pipeline_->votedClass(instance_[k], own);
    if (elected != own) voted[k] = table[elected].ids.front();
  }
}

/// Writes the result, and copies of the array what boxes need: it may change until they are asked for.
void ArraySegmenter::keepObjects(std::uint32_t* instances)
{
  const ClassTable& table = pipeline_->table();
  const Instances& in_image = pipeline_->instances();
  const ScanPoints points = scan_->points();
  for (std::size_t k = 0; k < instance_.size(); ++k)
  {
    const std::uint32_t id = instance_[k];
    instances[k] = id;
    if (id == 0) continue;
    for (auto next = static_cast<std::uint32_t>(objects_.size()); next < id; ++next)
      objects_.push_back({next + 1, 0, InstanceBox(), 0});
    ArrayObject& object = objects_[id - 1];
    if (object.points++ == 0)
    {
      const bool is_hidden = id > in_image.count();
      const ClassIndex index = is_hidden ? table.find(classes_[k]) : in_image.objects[id - 1].class_index;
      object.class_id = table[index].ids.front();
    }
    if (!hasDirection(points[k])) continue;
    things_.points.push_back({points[k].x, points[k].y, points[k].z, 0});
    things_of_.id.push_back(id);
  }
}

std::vector<ArrayObject> ArraySegmenter::objects()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::uint32_t> slot_of(objects_.size(), 0);  // of those that have coordinates, from 1
  Instances slots;
  for (const std::uint32_t id : things_of_.id)
  {
    std::uint32_t& slot = slot_of[id - 1];
    if (slot == 0)
    {
      slots.objects.emplace_back();
      slot = static_cast<std::uint32_t>(slots.objects.size());
    }
    ++slots.objects[slot - 1].point_count;
    slots.id.push_back(slot);
  }
  const std::vector<InstanceBox>& boxes = boxes_.fit(things_, slots);
  std::vector<ArrayObject> objects = objects_;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (slot_of[i] != 0) objects[i].box = boxes[slot_of[i] - 1];
  return objects;
}
}  // namespace lidar_panoptic_clustering
