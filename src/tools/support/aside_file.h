#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
/// A text file that is there whole or not at all: written to PATH.part and renamed. Opened before a long computation,
/// it shows at once that its place cannot be written. Removes what it began when it is destroyed without save().
/// What exists and is no regular file, a pipe or /dev/stdout, is written to as it is: renaming would replace it.
class AsideFile
{
public:
  /// Throws std::runtime_error with the path and the system's reason.
  explicit AsideFile(const std::string& path)
      : path_(path), aside_(isSpecial(path) ? path : path + ".part"), file_(std::fopen(aside_.c_str(), "wb"))
  {
    if (file_ == nullptr) fail();
  }
  ~AsideFile()
  {
    if (file_ != nullptr) std::fclose(file_);
    if (!saved_ && aside_ != path_) std::remove(aside_.c_str());
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
    if (!closed || (aside_ != path_ && std::rename(aside_.c_str(), path_.c_str()) != 0)) fail();
    saved_ = true;
  }

private:
  static bool isSpecial(const std::string& path)
  {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  }
  [[noreturn]] void fail() const { throw std::runtime_error("cannot write " + path_ + ": " + std::strerror(errno)); }

  std::string path_, aside_;
  std::FILE* file_;
  bool saved_ = false;
};
}  // namespace lidar_panoptic_clustering
