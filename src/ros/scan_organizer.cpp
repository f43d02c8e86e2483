#include "ros/scan_organizer.h"

#include "ros/message_reading.h"
#include "ros/original_message.h"

#include <pcl_conversions/pcl_conversions.h>

#include <chrono>

namespace lidar_panoptic_clustering
{
namespace
{
using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

OrganizerConfig withLabels(const ScanOrganizerConfig& config)
{
  OrganizerConfig organizer = config.organizer;
  organizer.labels = config.labeller.labels == "field";
  return organizer;
}
}  // namespace

ScanOrganizer::ScanOrganizer(const ScanOrganizerConfig& config)
    : config_(config),
      labeller_(config.labeller),
      organizer_(withLabels(config)),
      original_labeller_(labeller_.classTable(), config.lasting_ids)
{
}

void ScanOrganizer::organize(const sensor_msgs::PointCloud2& message, OrganizedFrame& frame)
{
  const auto start = Clock::now();
  organizer_.organize(viewOf(message), frame.scan);
  frame.organize_ms = millisecondsSince(start);
}

double ScanOrganizer::label(const sensor_msgs::PointCloud2& message, const LabelPart& labels, bool all_points,
                            OrganizedFrame& frame)
{
  const auto start = Clock::now();
  if (config_.labeller.labels == "none")
    labeller_.takeGeometry(frame.scan, all_points);
  else if (labels.image)
    labeller_.takeImage(viewOf(*labels.image), frame.scan);
  else if (labels.cloud)
    labeller_.takeCloud(viewOf(*labels.cloud), config_.organizer.label_field, viewOf(message), frame.scan);
  else
    labeller_.takeOwn(frame.scan);
  return millisecondsSince(start);
}

LabelledCloud::Ptr ScanOrganizer::takeImage(const std_msgs::Header& header, OrganizedScan& scan)
{
  LabelledCloud::Ptr cloud = pool_.take();
  cloud->swap(scan.image.cloud);  // the next frame goes into what came back
  scan.image.cloud.width = cloud->width, scan.image.cloud.height = cloud->height;
  pcl_conversions::toPCL(header, cloud->header);
  return cloud;
}

sensor_msgs::PointCloud2Ptr ScanOrganizer::carryBack(const OrganizedFrame& frame, const PanopticCloud& panoptic)
{
  original_labeller_.carryBack(frame.scan, panoptic, label_, instance_);
  addLabels(viewOf(*frame.message), label_, instance_, labelled_,
            config_.float_fields ? AddedType::kFloat32 : AddedType::kUint32);
  return toMessage(labelled_, *frame.message);
}
}  // namespace lidar_panoptic_clustering
