// The ids of every algorithm under every switch on scenes of all kinds, as checksums that were recorded once
// (partition_checksums.txt): what makes the code faster may not change one id.
//
// After a change that is meant to change ids: run this test with
// LIDAR_PANOPTIC_RECORD=test/pipeline/partition_checksums.txt. With LIDAR_PANOPTIC_ALL_SETTINGS=1 it compares all
// settings on all scenes.
#include "scan_fixture.h"
#include "unordered_clouds.h"
#include "worst_scans.h"

#include <gtest/gtest.h>
#include <pcl/pcl_config.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace lidar_panoptic_clustering
{
namespace
{
const char* const kRecorded = "test/pipeline/partition_checksums.txt";

/// FNV-1a over 32-bit words.
class Checksum
{
public:
  void add(std::uint32_t word) { sum_ = (sum_ ^ word) * 1099511628211ULL; }
  std::string text() const
  {
    std::ostringstream out;
    out << std::hex << ((sum_ >> 32U ^ sum_) & 0xFFFFFFFFU);
    return out.str();
  }

private:
  std::uint64_t sum_ = 14695981039346656037ULL;
};

std::string checksumOf(const LabelledCloud& scene)
{
  Checksum sum;
  sum.add(scene.width), sum.add(scene.height);
  for (const auto& p : scene.points)
  {
    std::uint32_t bits[3];
    std::memcpy(bits, p.data, sizeof(bits));
    for (const std::uint32_t word : bits) sum.add(word);
    sum.add(p.label);
  }
  return sum.text();
}

std::string checksumOf(const Instances& instances)
{
  Checksum sum;
  for (const std::uint32_t id : instances.id) sum.add(id);
  for (const auto& object : instances.objects) sum.add(object.point_count), sum.add(object.class_index);
  return sum.text();
}

struct Scene
{
  std::string name;
  LabelledCloud cloud;
};

LabelledCloud allCars(LabelledCloud cloud)
{
  for (auto& p : cloud.points) p.label = kCar;
  return cloud;
}

/// A third of the columns.
LabelledCloud sectorOf(const LabelledCloud& cloud)
{
  LabelledCloud sector(cloud.width / 3, cloud.height);
  for (std::uint32_t row = 0; row < sector.height; ++row)
    for (std::uint32_t column = 0; column < sector.width; ++column)
      sector.points[row * sector.width + column] = cloud.points[row * cloud.width + column];
  return sector;
}

/// Boxes of several classes drawn with whole numbers only, so that they are the same on every machine.
LabelledCloud drawnBoxes(std::uint32_t rows, std::uint32_t columns)
{
  LabelledCloud cloud = emptyCloud(rows, columns);
  std::mt19937 random(3);
  const auto upTo = [&random](unsigned n) { return static_cast<int>(random() % n); };
  const std::uint32_t labels[] = {kCar, kCar, kMovingCar, kPerson, kTruck, 20, 11, kRoad};
  for (int patch = 0; patch < 400; ++patch)
  {
    const int top = upTo(rows), left = upTo(columns), height = 1 + upTo(12), width = 1 + upTo(60);
    const int x = upTo(4000) - 2000, y = upTo(4000) - 2000, slope = upTo(9) - 4;
    const std::uint32_t label = labels[upTo(8)];
    for (int r = top; r < std::min<int>(rows, top + height); ++r)
      for (int c = left; c < left + width; ++c)
        cloud.points[static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c) % columns] =
            labelled(0.0078125F * static_cast<float>(x + 8 * (c - left) + upTo(6)),
                     0.0078125F * static_cast<float>(y + slope * (c - left) + upTo(6)),
                     0.0078125F * static_cast<float>(-10 * (r - top) - upTo(6)), label);
  }
  return cloud;
}

std::vector<Scene> scenes()
{
  std::vector<Scene> all = {{"drawn", drawnBoxes(48, 1024)}};
  for (const WorstScan& worst : worstScans()) all.push_back({worst.name, worst.build(32, 512)});
  const LabelledCloud street = simulatedScan("hdl64e", 0);
  all.push_back({"street", street});
  all.push_back({"street_later", simulatedScan("hdl64e", 170)});
  all.push_back({"street_sector", sectorOf(street)});
  all.push_back({"street_all_cars", allCars(street)});
  all.push_back({"os1_128", simulatedScan("os1_128", 40)});
  all.push_back({"vlp16_all_cars", allCars(simulatedScan("vlp16", 40))});
  return all;
}

/// Each parameter of the pipeline and of the algorithm away from its default, one at a time and some together.
std::vector<ParameterMap> settingsOf(const std::string& algorithm)
{
  std::vector<ParameterMap> settings = {
      {},
      surveyParameters(algorithm),
      {{"bridge_distance_m", 0.0}},
      {{"bridge_distance_m", 1.0}},
      {{"split", false}},
      {{"size_margin", 1.0}},
      {{"merge", false}},
      {{"vote", false}},
      {{"split", false}, {"merge", false}, {"bridge_distance_m", 0.0}},
      {{"min_points", 20}},
      {{"class_policy", std::string("group")}},
      {{"class_policy", std::string("any")}},
      {{"class_policy", std::string("any")}, {"bridge_distance_m", 0.0}, {"merge", false}},
      {{"link_distance_scale", 0.5}},
      {{"link_distance_scale", 2.5}},
      {{"field_of_view", std::string("sector")}},
      {{"max_range_m", 25.0}},
  };
  const std::map<std::string, std::vector<ParameterMap>> own = {
      {"euclidean", {{{"distance_m", 0.5}}, {{"voxel_m", 0.3}}, {{"distance_m", 0.05}, {"split", false}}}},
      {"supervoxel", {{{"normal_weight", 0.5}}, {{"voxel_m", 0.3}, {"seed_m", 2.0}}}},
      {"depth", {{{"max_distance_m", 0.6}}, {{"theta_deg", 20.0}}, {{"max_gap_px", 2}}}},
      {"scan_line_run",
       {{{"run_distance_m", 0.1}}, {{"line_distance_m", 0.4}}, {{"max_line_gap", 4}}, {{"max_window_px", 20}}}},
      {"birds_eye", {{{"distance_m", 0.3}}, {{"distance_m", 0.05}, {"split", false}}}},
  };
  if (const auto found = own.find(algorithm); found != own.end())
    settings.insert(settings.end(), found->second.begin(), found->second.end());
  return settings;
}

const char* const kNotRun = "-";

/// "scene checksum-of-the-scene algorithm checksum-of-the-ids ...", one column a setting. Every `stride`-th setting is
/// run, beginning with the `first`, and the default one; the others' columns say kNotRun.
std::string lineOf(const Scene& scene, const std::string& algorithm, std::size_t first, std::size_t stride)
{
  std::string line = scene.name + " " + checksumOf(scene.cloud) + " " + algorithm;
  const std::vector<ParameterMap> settings = settingsOf(algorithm);
  for (std::size_t k = 0; k < settings.size(); ++k)
  {
    line += " ";
    if (k != 0 && k % stride != first % stride)
    {
      line += kNotRun;
      continue;
    }
    Algorithm made = makeAlgorithm(algorithm, settings[k]);
    FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
    pipeline.segment(scene.cloud);
    line += checksumOf(pipeline.instances());
  }
  return line;
}

std::vector<std::string> words(const std::string& line)
{
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), std::istream_iterator<std::string>()};
}

/// The recorded line by scene and algorithm.
std::map<std::string, std::string> recordedLines(std::string& pcl_version)
{
  std::map<std::string, std::string> lines;
  std::ifstream in(kRecorded);
  std::getline(in, pcl_version);
  for (std::string line; std::getline(in, line);)
  {
    const auto word = words(line);
    lines[word.at(0) + " " + word.at(2)] = line;
  }
  return lines;
}

void compare(const std::string& now, const std::string& recorded)
{
  const auto is = words(now), was = words(recorded);
  ASSERT_EQ(is.size(), was.size()) << now << ": settings were added or taken away, record anew";
  for (std::size_t k = 3; k < is.size(); ++k)
    EXPECT_TRUE(is[k] == kNotRun || is[k] == was[k]) << is[0] << ", " << is[2] << ", setting " << k - 3;
}

TEST(PartitionChecksum, everyIdIsTheOneRecorded)
{
  std::string pcl_version;
  const auto recorded = recordedLines(pcl_version);
  std::ofstream anew;
  if (const char* path = std::getenv("LIDAR_PANOPTIC_RECORD"))
  {
    anew.open(path);
    anew << PCL_VERSION_PRETTY << '\n';
  }
  // all settings of all scenes take minutes: each scene takes a few of them, the next scene others
  const bool is_whole = anew.is_open() || std::getenv("LIDAR_PANOPTIC_ALL_SETTINGS") != nullptr;
  const std::size_t stride = is_whole ? 1 : 5;
  std::size_t compared = 0, scene_number = 0;
  for (const Scene& scene : scenes())
  {
    ++scene_number;
    for (const std::string& algorithm : algorithmNames())
    {
      // another version of PCL may number its supervoxels' seeds otherwise
      if (algorithm == "supervoxel" && pcl_version != PCL_VERSION_PRETTY && !anew.is_open()) continue;
      const auto line = recorded.find(scene.name + " " + algorithm);
      const bool is_known = line != recorded.end();
      // another C library's sines make another scene of a simulated one; "drawn" has none
      if (is_known && scene.name != "drawn" && words(line->second)[1] != checksumOf(scene.cloud) && !anew.is_open())
        continue;
      const std::string now = lineOf(scene, algorithm, scene_number, stride);
      if (anew.is_open())
      {
        anew << now << '\n';
        continue;
      }
      ASSERT_TRUE(is_known) << scene.name << ", " << algorithm << ": not recorded";
      compare(now, line->second);
      ++compared;
    }
  }
  EXPECT_TRUE(anew.is_open() || compared >= algorithmNames().size() - 1) << kRecorded;
  std::cout << compared << " of " << recorded.size() << " recorded lines compared\n";
}
}  // namespace
}  // namespace lidar_panoptic_clustering
