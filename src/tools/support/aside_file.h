#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
/// A text file that is there whole or not at all: written to PATH.part and renamed. Opened before a long computation,
/// it shows at once that its place cannot be written. Removes what it began when it is destroyed without save().
class AsideFile
{
public:
  /// Throws std::runtime_error with the path and the system's reason.
  explicit AsideFile(std::string path) : path_(std::move(path)), file_(std::fopen(aside().c_str(), "wb"))
  {
    if (file_ == nullptr) fail();
  }
  ~AsideFile()
  {
    if (file_ != nullptr) std::fclose(file_);
    if (!saved_) std::remove(aside().c_str());
  }
  AsideFile(const AsideFile&) = delete;
  AsideFile& operator=(const AsideFile&) = delete;

  /// Once. Throws std::runtime_error with the path and the system's reason (a full disk, for one).
  void save(const std::string& text)
  {
    const bool written = std::fwrite(text.data(), 1, text.size(), file_) == text.size() && std::fflush(file_) == 0;
    if (!written) fail();
    const bool closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!closed || std::rename(aside().c_str(), path_.c_str()) != 0) fail();
    saved_ = true;
  }

private:
  std::string aside() const { return path_ + ".part"; }
  [[noreturn]] void fail() const { throw std::runtime_error("cannot write " + path_ + ": " + std::strerror(errno)); }

  std::string path_;
  std::FILE* file_;
  bool saved_ = false;
};
}  // namespace lidar_panoptic_clustering
