#pragma once

#include "core/printable.h"

#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
/// Where a report is printed: at the end of a file, or on standard output.
class ReportOutput
{
public:
  /// An empty path stands for standard output. Throws std::runtime_error for a file that cannot be written to.
  void open(const std::string& path)
  {
    if (path.empty()) return;
    file_.open(path, std::ios::app);
    if (!file_) throw std::runtime_error("cannot write the report to '" + path + "'");
  }

  void print(const std::string& text) { (file_.is_open() ? file_ : std::cout) << printable(text) << std::flush; }

private:
  std::ofstream file_;
};
}  // namespace lidar_panoptic_clustering
