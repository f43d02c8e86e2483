#pragma once

#include <cstddef>
#include <string>

namespace lidar_panoptic_clustering
{
/// Makes an empty file PATH.PID-N.part of a name nobody else has, through no link; returns its name. Throws
/// std::runtime_error with `path` and the system's reason.
std::string makeAside(const std::string& path);

/// A file that is there whole or not at all: written without a name, which it gets when it is saved, so that nothing is
/// left of it however its process ends. On file systems that have no such files it is written beside its place, as
/// makeAside() has it, and renamed. Opened before a long computation, it shows at once that its place cannot be
/// written. Processes that write the same file do not meet: the last to save wins.
///
/// What exists and is no regular file, a pipe or /dev/stdout, is written to as it is: renaming would replace it.
class AsideFile
{
public:
  /// Throws std::runtime_error with the path and the system's reason.
  explicit AsideFile(const std::string& path);
  ~AsideFile();
  AsideFile(const AsideFile&) = delete;
  AsideFile& operator=(const AsideFile&) = delete;

  /// Each throws std::runtime_error with the path and the system's reason (a full disk, for one).
  void write(const void* bytes, std::size_t count);
  /// Once, after all has been written.
  void save();
  void save(const std::string& text);
  /// Once, with the whole text. Does not touch a file that came to be at the path meanwhile: then returns false.
  bool saveIfNone(const std::string& text);

private:
  int nameIt();

  std::string path_, aside_;  ///< the second is empty where the file has no name, or is written as it is
  int file_ = -1;
  bool nameless_ = false;
};
}  // namespace lidar_panoptic_clustering
