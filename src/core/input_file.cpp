#include "core/input_file.h"

#include "core/system_error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
const char* kindOf(mode_t mode)
{
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
  return "a socket";
}
}  // namespace

InputFile::InputFile(const std::string& path, std::uint64_t max_bytes)
    : path_(path), file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC))
{
  const auto fail = [&](const std::string& reason)
  {
    if (file_ >= 0) ::close(file_);
    throw std::runtime_error("cannot read " + path + ": " + reason);
  };
  struct stat status = {};
  if (file_ < 0 || ::fstat(file_, &status) != 0) fail(systemError(errno));
  if (!S_ISREG(status.st_mode)) fail(std::string("expected a file, found ") + kindOf(status.st_mode));
  size_ = static_cast<std::uint64_t>(status.st_size);
  if (size_ > max_bytes)
    fail("expected at most " + std::to_string(max_bytes) + " bytes, found " + std::to_string(size_));
}

InputFile::~InputFile()
{
  ::close(file_);
}

std::size_t InputFile::read(void* to, std::size_t count)
{
  std::size_t done = 0;
  while (done < count)
  {
    const ssize_t got = ::read(file_, static_cast<char*>(to) + done, count - done);
    if (got == 0) break;
    if (got > 0)
      done += static_cast<std::size_t>(got);
    else if (errno != EINTR)
      throw std::runtime_error("cannot read " + path_ + ": " + systemError(errno));
  }
  return done;
}

std::string readTextFile(const std::string& path, std::uint64_t max_bytes)
{
  InputFile file(path, max_bytes);
  std::string text(file.size(), '\0');
  text.resize(file.read(text.data(), text.size()));
  return text;
}
}  // namespace lidar_panoptic_clustering
