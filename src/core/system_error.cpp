#include "core/system_error.h"

#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
// strerror_r has two forms: one returns the text, which need not be in the buffer, the other whether it failed
[[maybe_unused]] std::string textOf(const char* text, const char*)
{
  return text;
}
[[maybe_unused]] std::string textOf(int failed, const char* buffer)
{
  return failed == 0 ? buffer : "unknown error";
}
}  // namespace

std::string systemError(int error)
{
  char buffer[256] = "";
  return textOf(strerror_r(error, buffer, sizeof buffer), buffer);
}
}  // namespace lidar_panoptic_clustering
