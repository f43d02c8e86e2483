#include "datasets/binary_file.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
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

[[noreturn]] void throwNotWritten(const std::string& path, int error)
{
  throw std::runtime_error("cannot write " + path + ": " + std::strerror(error));
}

/// Returns 0, or the error.
int writeAll(const std::string& path, const std::vector<std::uint32_t>& labels)
{
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return errno;
  std::setvbuf(file, nullptr, _IONBF, 0);
  const bool written = std::fwrite(labels.data(), sizeof(std::uint32_t), labels.size(), file) == labels.size();
  const int error = written ? 0 : errno;
  return std::fclose(file) == 0 || error != 0 ? error : errno;  // a network's file system reports a full disk here
}

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
  const std::string aside = path + ".part";
  int error = writeAll(aside, labels);
  if (error == 0 && std::rename(aside.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  fs::remove(aside, ignored);
  throwNotWritten(path, error);
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
