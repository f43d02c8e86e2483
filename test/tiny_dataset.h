#pragma once

#include "scan_fixture.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;

constexpr std::uint32_t kScanPoints = 24;

/// Writes `bytes` bytes of `values`, all where 0.
template <class T>
void writeFile(const fs::path& path, const std::vector<T>& values, std::size_t bytes = 0)
{
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(bytes > 0 ? bytes : values.size() * sizeof(T)));
}

inline void writeText(const fs::path& path, const std::string& text)
{
  std::ofstream(path) << text;
}

/// Three rings of eight points at 10 m and a little more in each scan.
inline std::vector<float> scanPoints(int scan)
{
  std::vector<float> values;
  for (int ring = 0; ring < 3; ++ring)
    for (int i = 0; i < 8; ++i)
    {
      const float azimuth = 0.4F + 0.7853982F * static_cast<float>(i);
      const float range = 10.0F + static_cast<float>(scan);
      for (const float value : {range * std::cos(azimuth), range * std::sin(azimuth), static_cast<float>(-ring), 0.25F})
        values.push_back(value);
    }
  return values;
}

/// The first ring's points are cars of instance 5, moving ones, the others road.
inline std::vector<std::uint32_t> scanLabels(std::uint32_t car_label = 5U << 16U | kMovingCar)
{
  std::vector<std::uint32_t> labels(kScanPoints, kRoad);
  std::fill(labels.begin(), labels.begin() + 8, car_label);
  return labels;
}

/// A data set of one sequence, 07, of three scans in a temporary folder, gone with the object.
class TinyDataset
{
public:
  explicit TinyDataset(const std::string& name)
      : root_(fs::temp_directory_path() / ("lidar_panoptic_" + name + "_" + std::to_string(getpid())))
  {
    fs::remove_all(root_);
    for (int scan = 0; scan < 3; ++scan)
    {
      writeFile(file("velodyne", scan, ".bin"), scanPoints(scan));
      writeFile(file("labels", scan, ".label"), scanLabels());
      writeFile(file("predictions", scan, ".label"), scanLabels(kPerson));
    }
    // the camera looks along the lidar's x, and drives 2 m a scan along its own z
    writeText(sequence() / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
    writeText(sequence() / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 4\n");
    writeText(sequence() / "times.txt", "0.0\n0.25\n0.5\n");
  }
  ~TinyDataset() { fs::remove_all(root_); }
  TinyDataset(const TinyDataset&) = delete;
  TinyDataset& operator=(const TinyDataset&) = delete;

  fs::path sequence() const { return root_ / "sequences" / "07"; }
  fs::path file(const std::string& folder, int scan, const std::string& ending) const
  {
    return sequence() / folder / ("00000" + std::to_string(scan) + ending);
  }

  const fs::path root_;
};

using PointSet = std::multiset<std::tuple<float, float, float, std::uint32_t>>;

template <class Cloud>
PointSet returnsIn(const Cloud& cloud)
{
  PointSet set;
  for (const auto& p : cloud.points)
    if (!std::isnan(p.x)) set.emplace(p.x, p.y, p.z, p.label);
  return set;
}

inline PointSet expectedReturns(int scan, std::uint32_t car_label)
{
  const auto values = scanPoints(scan);
  PointSet set;
  for (std::size_t i = 0; i < kScanPoints; ++i)
    set.emplace(values[4 * i], values[4 * i + 1], values[4 * i + 2], i < 8 ? car_label : kRoad);
  return set;
}
}  // namespace lidar_panoptic_clustering
