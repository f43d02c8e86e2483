#include "lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h"

#include <stdexcept>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
OrganizerConfig organizerConfig(const ScanToObjectsConfig& config)
{
  OrganizerConfig organizer = config.organizer;
  organizer.labels = config.labeller.labels == "field";
  return organizer;
}
}  // namespace

ScanToObjects::ScanToObjects(const ScanToObjectsConfig& config)
    : ScanToObjects(config, makeAlgorithm(config.algorithm, config.parameters))
{
}

ScanToObjects::ScanToObjects(const ScanToObjectsConfig& config, Algorithm algorithm)
    : labels_(config.labeller.labels),
      label_field_(config.organizer.label_field),
      organizer_(organizerConfig(config)),
      labeller_(config.labeller),
      pipeline_(labeller_.classTable(), algorithm.pipeline, std::move(algorithm.clusterer)),
      original_labeller_(labeller_.classTable()),
      boxes_(&box_fitter_.fit(pipeline_.things(), pipeline_.instances()))
{
}

void ScanToObjects::process(const RawCloud& cloud)
{
  if (labels_ != "none") require("field");
  organizer_.organize(cloud, scan_);
  if (labels_ == "none")
    labeller_.takeGeometry(scan_, !scan_.organized_input);  // else the pixels' labels are the points'
  else
    labeller_.takeOwn(scan_);
  find();
}

void ScanToObjects::process(const RawCloud& cloud, const RawCloud& labels)
{
  require("cloud");
  organizer_.organize(cloud, scan_);
  labeller_.takeCloud(labels, label_field_, cloud, scan_);
  find();
}

void ScanToObjects::process(const RawCloud& cloud, const RawImage& labels)
{
  require("image");
  organizer_.organize(cloud, scan_);
  labeller_.takeImage(labels, scan_);
  find();
}

void ScanToObjects::require(const char* expected) const
{
  if (labels_ != expected)
    throw std::invalid_argument("labels: expected '" + std::string(expected) + "' for what was given, found '" +
                                labels_ + "'");
}

void ScanToObjects::find()
{
  pipeline_.process(scan_.image.cloud, image_);
  boxes_ = &box_fitter_.fit(pipeline_.things(), pipeline_.instances());
  original_labeller_.carryBack(scan_, image_, label_, instance_);
}

RawCloud viewOf(const std::vector<ScanPoint>& points)
{
  static_assert(sizeof(ScanPoint) == 16);
  constexpr auto kFloat = static_cast<std::uint8_t>(NumberType::kFloat32);
  RawCloud cloud;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.height = 1;
  cloud.point_step = sizeof(ScanPoint);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.fields = {{"x", 0, kFloat, 1}, {"y", 4, kFloat, 1}, {"z", 8, kFloat, 1}, {"intensity", 12, kFloat, 1}};
  cloud.data = reinterpret_cast<const std::uint8_t*>(points.data());
  cloud.data_size = points.size() * sizeof(ScanPoint);
  return cloud;
}
}  // namespace lidar_panoptic_clustering
