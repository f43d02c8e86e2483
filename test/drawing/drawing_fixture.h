#pragma once

#include "drawing/canvas.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <iterator>
#include <string>

/// fontconfig keeps some patterns for the life of the process, whatever is drawn: not a leak of this package's.
extern "C" const char* __lsan_default_suppressions();
extern "C" __attribute__((weak)) const char* __lsan_default_suppressions()
{
  return "leak:libfontconfig\n";
}

namespace lidar_panoptic_clustering
{
/// A folder that goes away with the test.
class Drawing : public ::testing::Test
{
protected:
  Drawing()
  {
    folder_ = std::filesystem::temp_directory_path() / ("drawing_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~Drawing() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t fileCount() const
  {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

inline std::size_t countPixels(const Canvas& canvas, const Box& box, std::uint32_t rgb)
{
  std::size_t count = 0;
  for (int y = static_cast<int>(box.y); y < static_cast<int>(box.bottom()); ++y)
    for (int x = static_cast<int>(box.x); x < static_cast<int>(box.right()); ++x)
      if (canvas.pixel(x, y) == rgb) ++count;
  return count;
}

/// What an action throws says; empty where it throws nothing.
inline std::string messageOf(const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const std::exception& error)
  {
    return error.what();
  }
  return "";
}
}  // namespace lidar_panoptic_clustering
