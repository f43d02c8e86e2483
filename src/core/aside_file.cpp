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

/// A name beside `path` that no other process and no earlier call takes.
std::string nameAside(const std::string& path)
{
  static std::atomic<unsigned> count{0};
  return path + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".part";
}

constexpr int kTries = 1000;  // names left by processes that had this one's number

/// Opens a new file beside `path`; its name goes to `aside`. -1, with errno, where that cannot be.
int openAside(const std::string& path, std::string& aside)
{
  int file = -1;
  for (int i = 0; i < kTries && file < 0; ++i)
  {
    aside = nameAside(path);
    file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) break;
  }
  return file;
}

std::string processFile(int file)
{
  return "/proc/self/fd/" + std::to_string(file);
}

/// Gives a file without a name the name `path`. False, with errno, where that cannot be.
bool link(int file, const std::string& path)
{
  return ::linkat(AT_FDCWD, processFile(file).c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

/// Opens a file without a name in the folder of `path`: it goes with the process, whatever ends that. -1 where the
/// file system has none, or nothing could name it later.
int openNameless(const std::string& path)
{
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int file = ::open(folder.empty() ? "." : folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (file < 0 || ::access(processFile(file).c_str(), F_OK) == 0) return file;
  ::close(file);
  return -1;
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
  {
    file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  }
  else
  {
    file_ = openNameless(path);
    nameless_ = file_ >= 0;
    if (!nameless_) file_ = openAside(path, aside_);
  }
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
  int error = nameless_ ? nameIt() : 0;
  // a network's file system reports a full disk when the file is closed
  if (::close(file_) != 0 && error == 0) error = errno;
  file_ = -1;
  if (aside_.empty() && error == 0) return;
  if (error == 0 && std::rename(aside_.c_str(), path_.c_str()) != 0) error = errno;
  if (error == 0) return;
  if (!aside_.empty()) ::unlink(aside_.c_str());
  throwNotWritten(path_, error);
}

/// Only a file that has a name can take another's place. Returns the system's error, 0 for none.
int AsideFile::nameIt()
{
  for (int i = 0; i < kTries; ++i)
  {
    aside_ = nameAside(path_);
    if (link(file_, aside_)) return 0;
    if (errno != EEXIST) break;
  }
  aside_.clear();
  return errno;
}

bool AsideFile::saveIfNone(const std::string& text)
{
  write(text.data(), text.size());
  if (!nameless_ && aside_.empty()) return save(), true;
  // the destructor takes the other name away
  if (nameless_ ? link(file_, path_) : ::link(aside_.c_str(), path_.c_str()) == 0) return true;
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
