#pragma once

#include <cstdint>
#include <string>

namespace lidar_panoptic_clustering
{
/// A file that is read whole and once. Opening never waits, and what never ends is not begun with: only regular files
/// are taken, no pipes, devices or folders.
class InputFile
{
public:
  /// Throws std::runtime_error with the path and the reason: missing, no regular file, or above `max_bytes`.
  InputFile(const std::string& path, std::uint64_t max_bytes);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::uint64_t size() const { return size_; }
  /// Reads up to `count` bytes; fewer only at the end of the file. Throws std::runtime_error.
  std::size_t read(void* to, std::size_t count);

private:
  std::string path_;
  int file_;
  std::uint64_t size_ = 0;
};

/// The whole text. Throws as InputFile does.
std::string readTextFile(const std::string& path, std::uint64_t max_bytes);
}  // namespace lidar_panoptic_clustering
