#include "core/aside_file.h"
#include "datasets/binary_file.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;
namespace
{
constexpr std::uint32_t kMaxInstance = 0xFFFFU;

/// Whether each label but 0 is, bit for bit, a whole number as float32, which the class ids of no file all are. Returns
/// the first of them, else nothing.
std::optional<float> firstFloat(const std::vector<std::uint32_t>& labels)
{
  constexpr float kLargestId = 65535.0F;
  std::optional<float> first;
  for (const std::uint32_t label : labels)
  {
    if (label == 0) continue;
    float number = 0.0F;
    std::memcpy(&number, &label, sizeof(number));
    if (!(number >= -1.0F && number <= kLargestId) || number != std::floor(number)) return std::nullopt;
    if (!first) first = number;
  }
  return first;
}
}  // namespace

void readLabelFile(const std::string& path, std::vector<std::uint32_t>& labels)
{
  readBinaryFile(path, labels);
  if (const auto number = firstFloat(labels))
    throw std::runtime_error(path + ": expected uint32 labels, found float32 numbers, the first of them " +
                             std::to_string(std::lround(*number)) +
                             ": write them as integers (numpy: labels.astype('<u4').tofile(..))");
}

void writeLabelFile(const std::string& path, const std::vector<std::uint32_t>& labels)
{
  std::error_code ignored;
  fs::create_directories(fs::path(path).parent_path(), ignored);  // what went wrong shows when the file is opened
  AsideFile file(path);
  file.write(labels.data(), labels.size() * sizeof(std::uint32_t));
  file.save();
}

void encodeLabels(const std::vector<std::uint32_t>& classes, const std::vector<std::uint32_t>& instances,
                  const ClassTable& table, std::vector<std::uint32_t>& labels)
{
  if (classes.size() != instances.size())
    throw std::invalid_argument("expected as many instances as classes, found " + std::to_string(instances.size()) +
                                " and " + std::to_string(classes.size()));
  std::array<std::uint32_t, 256> canonical{};
  for (std::size_t i = 0; i < table.size(); ++i)
    if (const auto& ids = table[static_cast<ClassIndex>(i)].ids; !ids.empty()) canonical[i] = ids.front();
  labels.resize(classes.size());
  for (std::size_t i = 0; i < classes.size(); ++i)
  {
    if (instances[i] > kMaxInstance)
      throw std::runtime_error("a label file holds at most 65535 instances, found instance " +
                               std::to_string(instances[i]));
    labels[i] = instances[i] << 16U | canonical[table.find(rawClass(classes[i]))];
  }
}
}  // namespace lidar_panoptic_clustering
