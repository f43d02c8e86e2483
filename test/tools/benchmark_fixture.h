#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace fs = std::filesystem;
using Labels = std::vector<std::uint32_t>;
constexpr std::uint32_t kCar = 10, kMovingCar = 252, kRoad = 40;

template <class T>
void write(const fs::path& path, const std::vector<T>& values)
{
  fs::create_directories(path.parent_path());
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

inline std::string read(const fs::path& path)
{
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline Labels readLabels(const fs::path& path)
{
  const std::string bytes = read(path);
  Labels labels(bytes.size() / 4);
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(labels.data()));
  return labels;
}

/// Files begun and not finished, below a folder.
inline int partsLeft(const fs::path& folder)
{
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.path().extension() == ".part";
  return count;
}

/// Runs the program, which is built into the folder of this test, on a data set of two sequences of three scans: two
/// walls of a car each, 1.5 m apart, 60 points each in one ring, one of them with some points of class 252; and road.
class PanopticBenchmark : public testing::Test
{
protected:
  void SetUp() override
  {
    const char* given = std::getenv("PANOPTIC_BENCHMARK");
    program_ = given != nullptr ? given : fs::read_symlink("/proc/self/exe").parent_path() / "panoptic_benchmark";
    ASSERT_TRUE(fs::exists(program_)) << program_ << " is not built";
    std::string pattern = (fs::temp_directory_path() / "panoptic_benchmark_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    for (const std::string sequence : {"03", "08"})
      for (std::uint32_t scan = 0; scan < 3; ++scan) writeScan(sequence, scan);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void writeScan(const std::string& sequence, std::uint32_t scan) const
  {
    std::vector<float> points;
    Labels labels;
    const auto add = [&](float y, std::uint32_t label)
    {
      points.insert(points.end(), {10.0F + 0.1F * static_cast<float>(scan), y, 0.0F, 0.5F});
      labels.push_back(label);
    };
    for (int i = 0; i < 60; ++i) add(0.5F + 0.05F * static_cast<float>(i), 7U << 16U | kCar);
    for (int i = 0; i < 60; ++i) add(5.0F + 0.05F * static_cast<float>(i), 8U << 16U | kMovingCar);
    for (int i = 0; i < 80; ++i) add(8.1F + 0.05F * static_cast<float>(i), kRoad);
    write(scanFile(sequence, scan), points);
    write(truth(sequence, scan), labels);
    for (std::uint32_t& label : labels) label &= 0xFFFFU;
    for (std::size_t i = 60; i < 70; ++i) labels[i] = kCar;
    write(semantics(sequence, scan), labels);
  }

  static std::string number(std::uint32_t scan) { return "00000" + std::to_string(scan); }
  fs::path sequenceFolder(const std::string& sequence) const { return folder_ / "data/sequences" / sequence; }
  fs::path scanFile(const std::string& sequence, std::uint32_t scan) const
  {
    return sequenceFolder(sequence) / "velodyne" / (number(scan) + ".bin");
  }
  fs::path truth(const std::string& sequence, std::uint32_t scan) const
  {
    return sequenceFolder(sequence) / "labels" / (number(scan) + ".label");
  }
  fs::path semantics(const std::string& sequence, std::uint32_t scan) const
  {
    return folder_ / "net/sequences" / sequence / "predictions" / (number(scan) + ".label");
  }
  fs::path output(const std::string& row, const std::string& sequence, std::uint32_t scan) const
  {
    return folder_ / "out" / row / "sequences" / sequence / "predictions" / (number(scan) + ".label");
  }

  /// Exit status; what the program prints is in out() and err() afterwards.
  int run(const std::string& arguments) const
  {
    const std::string command =
        "cd '" + folder_.string() + "' && '" + program_.string() + "' " + arguments + " >out.txt 2>err.txt";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  int benchmark(const std::string& more = "") const { return run("--dataset data --columns 512 " + more); }
  std::string out() const { return read(folder_ / "out.txt"); }
  std::string err() const { return read(folder_ / "err.txt"); }
  nlohmann::json report(const std::string& name) const { return nlohmann::json::parse(read(folder_ / name)); }
  std::string quality(const std::string& name) const { return report(name).at("quality").dump(); }

  /// Expects failure, `parts` of the message, and no report.
  void expectFailure(const std::string& more, const std::vector<std::string>& parts) const
  {
    EXPECT_EQ(benchmark("--report r.json " + more), 1) << more;
    for (const std::string& part : parts) EXPECT_NE(err().find(part), std::string::npos) << part << "\n" << err();
    EXPECT_FALSE(fs::exists(folder_ / "r.json"));
    EXPECT_EQ(partsLeft(folder_), 0);
  }

  fs::path folder_, program_;
};
}  // namespace lidar_panoptic_clustering
