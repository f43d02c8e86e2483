#pragma once

#include <cstddef>
#include <string>

namespace lidar_panoptic_clustering
{
/// Makes an empty file PATH.PID-N.part of a name nobody else has, through no link; returns its name. Throws
/// std::runtime_error with `path` and the system's reason.
std::string makeAside(const std::string& path);

/// A file that is there whole or not at all: written beside its place, as makeAside() has it, and renamed. Opened
/// before a long computation, it shows at once that its place cannot be written. Removes what it began when it is
/// destroyed without save(). Processes that write the same file do not meet: the last to save wins.
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
  std::string path_, aside_;
  int file_ = -1;
};
}  // namespace lidar_panoptic_clustering
