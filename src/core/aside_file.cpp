#include "core/aside_file.h"

#include "core/system_error.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
[[noreturn]] void throwNotWritten(const std::string& path, int error)
{
  throw std::runtime_error("cannot write " + path + ": " + systemError(error));
}

bool isSpecial(const std::string& path)
{
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

/// Opens a new file beside `path`; its name goes to `aside`. -1, with errno, where that cannot be.
int openAside(const std::string& path, std::string& aside)
{
  static std::atomic<unsigned> count{0};
  constexpr int kTries = 1000;  // names left by processes that had this one's number
  int file = -1;
  for (int i = 0; i < kTries && file < 0; ++i)
  {
    aside = path + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".part";
    file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) break;
  }
  return file;
}
}  // namespace

std::string makeAside(const std::string& path)
{
  std::string aside;
  const int file = openAside(path, aside);
  if (file < 0) throwNotWritten(path, errno);
  ::close(file);
  return aside;
}

AsideFile::AsideFile(const std::string& path) : path_(path)
{
  if (isSpecial(path))
    file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  else
    file_ = openAside(path, aside_);
  if (file_ < 0) throwNotWritten(path_, errno);
}

AsideFile::~AsideFile()
{
  if (file_ < 0) return;
  ::close(file_);
  if (!aside_.empty()) ::unlink(aside_.c_str());
}

void AsideFile::write(const void* bytes, std::size_t count)
{
  for (const char* from = static_cast<const char*>(bytes); count > 0;)
  {
    const ssize_t done = ::write(file_, from, count);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throwNotWritten(path_, errno);
    from += done;
    count -= static_cast<std::size_t>(done);
  }
}

void AsideFile::save()
{
  // a network's file system reports a full disk when the file is closed
  int error = ::close(file_) == 0 ? 0 : errno;
  file_ = -1;
  if (aside_.empty() && error == 0) return;
  if (error == 0 && std::rename(aside_.c_str(), path_.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(aside_.c_str());
  throwNotWritten(path_, error);
}

bool AsideFile::saveIfNone(const std::string& text)
{
  write(text.data(), text.size());
  if (aside_.empty()) return save(), true;
  if (::link(aside_.c_str(), path_.c_str()) == 0) return true;  // the destructor takes the other name away
  if (errno == EEXIST) return false;
  save();  // a file system without hard links
  return true;
}

void AsideFile::save(const std::string& text)
{
  write(text.data(), text.size());
  save();
}
}  // namespace lidar_panoptic_clustering
