#include "lidar_panoptic_clustering/projection/hidden_points.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kReachM = 1.0F;
constexpr int kRows = 2;
constexpr int kMinColumns = 2, kMaxColumns = 24;
constexpr int kOrphanRows = 4, kOrphanColumns = 8;
constexpr float kFullTurn = 6.28318530717959F;
constexpr auto kNone = Projection::kNone;

int columnsWithinReach(const ScanPoint& point, std::uint32_t width)
{
  const float columns = kReachM * static_cast<float>(width) / (kFullTurn * std::hypot(point.x, point.y));
  // infinity or NaN, of a point at the sensor or without coordinates, become the maximum
  return std::max(kMinColumns, static_cast<int>(std::ceil(std::min(static_cast<float>(kMaxColumns), columns))));
}

void requireSize(const char* what, std::size_t found, std::size_t expected)
{
  if (found != expected)
    throw std::invalid_argument(std::string("expected ") + std::to_string(expected) + " " + what + ", found " +
                                std::to_string(found));
}
}  // namespace

/// The pixels around one, over the wrap, each once.
class HiddenPointLabeller::Window
{
public:
  Window(const LabelledCloud& image, std::uint32_t pixel, int rows, int columns) : width_(static_cast<int>(image.width))
  {
    const int row = static_cast<int>(pixel / image.width), column = static_cast<int>(pixel % image.width);
    first_row_ = std::max(0, row - rows);
    last_row_ = std::min(static_cast<int>(image.height) - 1, row + rows);
    columns_ = std::min(2 * columns + 1, width_);
    first_column_ = (column - std::min(columns, width_ / 2) + width_) % width_;
  }

  template <class Visitor>
  void forEachPixel(Visitor&& visit) const
  {
    const int before_wrap = std::min(columns_, width_ - first_column_);
    for (int row = first_row_; row <= last_row_; ++row)
    {
      const int begin = row * width_;
      for (int i = 0; i < before_wrap; ++i) visit(static_cast<std::uint32_t>(begin + first_column_ + i));
      for (int i = before_wrap; i < columns_; ++i) visit(static_cast<std::uint32_t>(begin + i - before_wrap));
    }
  }

private:
  int width_, first_row_, last_row_, first_column_, columns_;
};

void pixelInstances(const PanopticCloud& clustered, std::vector<std::uint32_t>& instance_of_pixel)
{
  instance_of_pixel.resize(clustered.size());
  for (std::size_t i = 0; i < clustered.size(); ++i) instance_of_pixel[i] = clustered.points[i].instance;
}

void pixelInstances(const ThingScan& things, const Instances& instances, std::vector<std::uint32_t>& instance_of_pixel)
{
  instance_of_pixel.assign(std::size_t{things.rows} * things.columns, 0);
  for (std::uint32_t row = 0; row < things.rows; ++row)
    for (auto i = things.line_begin[row]; i < things.line_begin[row + 1]; ++i)
      instance_of_pixel[row * things.columns + things.points[i].column] = instances.id[i];
}

HiddenPointLabeller::HiddenPointLabeller(std::shared_ptr<const ClassTable> table, std::uint32_t class_bits,
                                         std::uint32_t own_ids_above)
    : table_(std::move(table)),
      class_bits_(class_bits),
      own_ids_above_(own_ids_above),
      thing_class_(table_->size(), kUnknownClass)
{
  for (std::size_t i = 0; i < table_->size(); ++i)
    if ((*table_)[static_cast<ClassIndex>(i)].isThing()) thing_class_[i] = static_cast<ClassIndex>(i);
}

void HiddenPointLabeller::label(ScanPoints scan, const std::vector<std::uint32_t>& labels, const Projection& projection,
                                const std::vector<std::uint32_t>& instance_of_pixel,
                                std::vector<std::uint32_t>& instance)
{
  requireSize("labels, one a point", labels.size(), scan.size());
  requireSize("projected points, one a point", projection.pixel_of_point.size(), scan.size());
  requireSize("instances, one a pixel", instance_of_pixel.size(), projection.owner_of_pixel.size());

  takeOwners(labels, projection, instance_of_pixel, instance);
  orphans_.clear();
  orphan_points_.clear();
  for (const std::uint32_t point : hidden_)
  {
    const ClassIndex class_index = table_->find(labels[point] & class_bits_);
    const std::uint32_t pixel = projection.pixel_of_point[point];
    const int columns = columnsWithinReach(scan[point], projection.cloud.width);
    auto owner = nearestOwner(scan, projection, point, class_index, Window(projection.cloud, pixel, kRows, columns));
    if (owner == kNone)
      owner =
          nearestOwner(scan, projection, point, class_index, Window(projection.cloud, pixel, 2 * kRows, 2 * columns));
    if (owner == kNone)
      addOrphan(point, class_index, projection);
    else
      instance[point] = instance[owner];
  }
  numberOrphans(projection.cloud, instance);
}

void HiddenPointLabeller::takeOwners(const std::vector<std::uint32_t>& labels, const Projection& projection,
                                     const std::vector<std::uint32_t>& instance_of_pixel,
                                     std::vector<std::uint32_t>& instance)
{
  instance.assign(labels.size(), 0);
  pixel_class_.assign(projection.owner_of_pixel.size(), kUnknownClass);
  hidden_.clear();
  largest_id_ = own_ids_above_;
  for (std::uint32_t point = 0; point < labels.size(); ++point)
  {
    const ClassIndex class_index = thing_class_[table_->find(labels[point] & class_bits_)];
    if (class_index == kUnknownClass) continue;
    const std::uint32_t pixel = projection.pixel_of_point[point];
    if (projection.owner_of_pixel[pixel] != point)
    {
      hidden_.push_back(point);
      continue;
    }
    pixel_class_[pixel] = class_index;
    instance[point] = instance_of_pixel[pixel];
    largest_id_ = std::max(largest_id_, instance[point]);
  }
}

std::uint32_t HiddenPointLabeller::nearestOwner(ScanPoints scan, const Projection& projection, std::uint32_t point,
                                                ClassIndex class_index, const Window& window) const
{
  const ScanPoint& from = scan[point];
  float least = std::numeric_limits<float>::infinity();
  std::uint32_t nearest = kNone;
  window.forEachPixel(
      [&](std::uint32_t pixel)
      {
        if (pixel_class_[pixel] != class_index) return;
        const std::uint32_t owner = projection.owner_of_pixel[pixel];
        const float dx = scan[owner].x - from.x, dy = scan[owner].y - from.y, dz = scan[owner].z - from.z;
        const float squared_distance = dx * dx + dy * dy + dz * dz;
        if (squared_distance < least) least = squared_distance, nearest = owner;
      });
  return nearest;
}

void HiddenPointLabeller::addOrphan(std::uint32_t point, ClassIndex class_index, const Projection& projection)
{
  const std::uint32_t pixel = projection.pixel_of_point[point];
  if (orphans_.empty()) orphans_of_pixel_.assign(projection.owner_of_pixel.size(), kNone);
  std::uint32_t entry = orphans_of_pixel_[pixel];
  while (entry != kNone && orphans_[entry].class_index != class_index) entry = orphans_[entry].next;
  if (entry == kNone)
  {
    entry = static_cast<std::uint32_t>(orphans_.size());
    orphans_.push_back({pixel, class_index, orphans_of_pixel_[pixel]});
    orphans_of_pixel_[pixel] = entry;
  }
  orphan_points_.push_back({point, entry});
}

void HiddenPointLabeller::numberOrphans(const LabelledCloud& image, std::vector<std::uint32_t>& instance)
{
  if (orphans_.empty()) return;
  sets_.reset(orphans_.size());
  for (std::uint32_t i = 0; i < orphans_.size(); ++i)
    Window(image, orphans_[i].pixel, kOrphanRows, kOrphanColumns)
        .forEachPixel(
            [&](std::uint32_t pixel)
            {
              for (auto other = orphans_of_pixel_[pixel]; other != kNone; other = orphans_[other].next)
                if (orphans_[other].class_index == orphans_[i].class_index) sets_.unite(i, other);
            });
  sets_.flatten(representative_);
  id_of_set_.assign(orphans_.size(), 0);
  for (const auto& [point, entry] : orphan_points_)
  {
    auto& id = id_of_set_[representative_[entry]];
    if (id == 0) id = ++largest_id_;
    instance[point] = id;
  }
}
}  // namespace lidar_panoptic_clustering
