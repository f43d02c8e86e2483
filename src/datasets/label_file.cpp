#include "core/aside_file.h"
#include "datasets/binary_file.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <array>
#include <filesystem>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;
namespace
{
constexpr std::uint32_t kMaxInstance = 0xFFFFU;
}  // namespace

void readLabelFile(const std::string& path, std::vector<std::uint32_t>& labels)
{
  readBinaryFile(path, labels);
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
