#include "python/array_scan.h"

#include "lidar_panoptic_clustering/core/parameters.h"

#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
OrganizerConfig organizerConfig(const ArrayScanConfig& config, bool labels)
{
  OrganizerConfig organizer = config.organizer;
  organizer.labels = labels;
  return organizer;
}
}  // namespace

ArrayScan::ArrayScan(const ArrayScanConfig& config) : config_(config)
{
  validateParameters(config);
  const int columns = config.organizer.columns == 0 ? ArrayScanConfig::kColumns : config.organizer.columns;
  projector_.emplace(ProjectionConfig{config.rows, columns});
  pristine_with_labels_.emplace(organizerConfig(config, true));
  pristine_without_.emplace(organizerConfig(config, false));
}

void ArrayScan::place(const PointsView& points, const std::vector<std::uint32_t>& classes, const IdsView* ring)
{
  points_ = readPoints(points, buffer_);
  is_image_ = false;
  if (ring != nullptr) readIds(*ring, "ring", ring_);
  const bool by_itself = config_.organizer.layout == "auto" && ring == nullptr;
  if (by_itself && points.organized)
    takeImage(points, classes);
  else if (by_itself)
    unfold(classes);
  else
    organize(points, classes, ring);
}

void ArrayScan::takeImage(const PointsView& points, const std::vector<std::uint32_t>& classes)
{
  is_image_ = true;
  scan_.layout = Layout::kOrganized;
  scan_.organized_input = true;
  LabelledCloud& cloud = scan_.image.cloud;
  cloud.width = static_cast<std::uint32_t>(points.width), cloud.height = static_cast<std::uint32_t>(points.height);
  cloud.is_dense = false;
  cloud.points.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    LabelledPoint& to = cloud.points[i];
    const ScanPoint& from = points_[i];
    to.x = from.x, to.y = from.y, to.z = from.z, to.intensity = from.remission;
    to.label = classes.empty() ? 0 : classes[i];
  }
}

void ArrayScan::unfold(const std::vector<std::uint32_t>& classes)
{
  scan_.layout = Layout::kUnfold;
  scan_.organized_input = false;
  projector_->project(points_, classes, scan_.image);
  const auto rows = static_cast<std::uint32_t>(config_.rows);
  if (scan_.image.rings > rows + rows / 4 + 1)
    throw std::invalid_argument("points: expected them ring after ring as in KITTI's files, up to " +
                                std::to_string(rows) + " rings (rows), found " + std::to_string(scan_.image.rings) +
                                ": say how many rings the sensor has (rows=), give the index of each point's ring "
                                "(ring=), or say that there are no scan lines (layout='merged')");
}

void ArrayScan::organize(const PointsView& points, const std::vector<std::uint32_t>& classes, const IdsView* ring)
{
  raw_.resize(points.size());
  for (std::size_t i = 0; i < raw_.size(); ++i)
    raw_[i] = {points_[i], classes.empty() ? 0 : classes[i], ring != nullptr ? ring_[i] : 0};
  constexpr auto kFloat = static_cast<std::uint8_t>(NumberType::kFloat32);
  constexpr auto kId = static_cast<std::uint8_t>(NumberType::kUint32);
  RawCloud cloud;
  cloud.width = static_cast<std::uint32_t>(points.width), cloud.height = static_cast<std::uint32_t>(points.height);
  cloud.point_step = sizeof(RawPoint);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.fields = {{"x", 0, kFloat, 1}, {"y", 4, kFloat, 1}, {"z", 8, kFloat, 1}, {"intensity", 12, kFloat, 1}};
  if (!classes.empty()) cloud.fields.push_back({"label", 16, kId, 1});
  if (ring != nullptr) cloud.fields.push_back({"ring", 20, kId, 1});
  cloud.data = reinterpret_cast<const std::uint8_t*>(raw_.data());
  cloud.data_size = raw_.size() * sizeof(RawPoint);
  Organizer organizer = classes.empty() ? *pristine_without_ : *pristine_with_labels_;
  organizer.organize(cloud, scan_);
  points_ = scan_.points;
}
}  // namespace lidar_panoptic_clustering
