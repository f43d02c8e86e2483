#include "lidar_panoptic_clustering/projection/original_labeller.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
VoxelKey keyOf(std::uint32_t id)
{
  return {static_cast<std::int32_t>(id & 0xFFFFU), static_cast<std::int32_t>(id >> 16U), 0};
}
}  // namespace

OriginalLabeller::OriginalLabeller(std::shared_ptr<const ClassTable> table, bool lasting_ids)
    : table_(std::move(table)), hidden_points_(table_, 0xFFFFFFFFU, lasting_ids ? kNoTrack : 0)
{
}

void OriginalLabeller::carryBack(const OrganizedScan& scan, const PanopticCloud& clustered,
                                 std::vector<std::uint32_t>& label, std::vector<std::uint32_t>& instance)
{
  const Projection& image = scan.image;
  if (clustered.width != image.cloud.width || clustered.height != image.cloud.height ||
      clustered.size() != image.owner_of_pixel.size())
    throw std::invalid_argument("expected a clustered cloud of " + std::to_string(image.cloud.height) + " x " +
                                std::to_string(image.cloud.width) + " (rows x columns), found " +
                                std::to_string(clustered.height) + " x " + std::to_string(clustered.width) + " with " +
                                std::to_string(clustered.size()) + " points");
  if (scan.organized_input) return copyPixels(image, clustered, label, instance);
  pixelInstances(clustered, instance_of_pixel_);
  hidden_points_.label(scan.points, scan.labels, image, instance_of_pixel_, instance);
  takeVotes(scan, clustered);
  label = scan.labels;
  if (voted_label_.empty()) return;
  for (std::size_t i = 0; i < label.size(); ++i)
  {
    if (instance[i] == 0) continue;
    const std::uint32_t number = voted_.find(keyOf(instance[i]));
    if (number == VoxelIndex::kNone) continue;
    const std::uint32_t voted = voted_label_[number];
    if (table_->find(label[i]) != table_->find(voted)) label[i] = voted;
  }
}

/// Where the points came firing after firing, neighbours among them lie in different rows of the image: then some
/// firings together, so that what a row's next pixels share of the cache is still there when their firing's turn comes.
void OriginalLabeller::copyPixels(const Projection& image, const PanopticCloud& clustered,
                                  std::vector<std::uint32_t>& label, std::vector<std::uint32_t>& instance)
{
  const std::size_t size = image.pixel_of_point.size();
  label.resize(size), instance.resize(size);
  const auto copy = [&](std::size_t i)
  {
    const PanopticPoint& from = clustered.points[image.pixel_of_point[i]];
    label[i] = from.label, instance[i] = from.instance;
  };
  const std::size_t rows = clustered.height, columns = clustered.width;
  const bool is_transposed =
      size == rows * columns && rows > 1 && image.pixel_of_point[0] / columns != image.pixel_of_point[1] / columns;
  if (!is_transposed)
  {
    for (std::size_t i = 0; i < size; ++i) copy(i);
    return;
  }
  constexpr std::size_t kTogether = 32;
  for (std::size_t begin = 0; begin < columns; begin += kTogether)
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = begin; column < std::min(begin + kTogether, columns); ++column)
        copy(column * rows + row);
}

/// The vote changes the labels of the outvoted points alone, all of an instance to the same one.
void OriginalLabeller::takeVotes(const OrganizedScan& scan, const PanopticCloud& clustered)
{
  voted_.reset();
  voted_label_.clear();
  for (std::size_t pixel = 0; pixel < clustered.size(); ++pixel)
  {
    const std::uint32_t owner = scan.image.owner_of_pixel[pixel], id = instance_of_pixel_[pixel];
    if (owner == Projection::kNone || id == 0 || clustered.points[pixel].label == scan.labels[owner]) continue;
    const std::uint32_t number = voted_.insert(keyOf(id));
    voted_label_.resize(voted_.size());
    voted_label_[number] = clustered.points[pixel].label;
  }
}
}  // namespace lidar_panoptic_clustering
