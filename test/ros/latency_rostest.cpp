#include "graph_fixture.h"
#include "labelled_scene.h"

#include "reporting/frame_report.h"

#include <pcl_ros/point_cloud.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace lidar_panoptic_clustering
{
namespace
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // ROS's own nodelet manager cannot load what is built so
#else
constexpr bool kSanitized = false;
#endif

/// A report's table, read again.
struct Table
{
  std::string graph, algorithm;
  std::size_t scans = 0, dropped = 0;
  std::map<std::string, std::vector<double>> percentiles;  ///< by measure, from the least to the longest
  std::string last_line;
};

std::string column(const std::string& line, std::size_t begin, std::size_t width)
{
  const std::string text = line.substr(begin, width);
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

Table parse(const std::string& text)
{
  constexpr std::size_t kMeasure = 47, kValues = 73;  // where these columns begin
  Table table;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); table.last_line = line)
  {
    if (line.size() < kValues) continue;
    std::istringstream numbers(line.substr(kValues));
    const std::vector<double> values(std::istream_iterator<double>(numbers), {});
    if (values.empty()) continue;  // the head
    table.percentiles[column(line, kMeasure, kValues - kMeasure)] = values;
    if (line.front() == ' ') continue;
    table.graph = column(line, 0, 16), table.algorithm = column(line, 17, 13);
    table.scans = std::stoul(line.substr(31, 6)), table.dropped = std::stoul(line.substr(38, 7));
  }
  return table;
}

void expectPlausible(const Table& table)
{
  ASSERT_EQ(table.percentiles.size(), 3U);
  for (const auto& [measure, values] : table.percentiles)
  {
    SCOPED_TRACE(measure);
    ASSERT_EQ(values.size(), 6U);
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
    EXPECT_GT(values.front(), 0.0);
    EXPECT_LT(values.back(), 30000.0);
  }
  // what is in a longer way takes less
  const auto& age = table.percentiles.at("stamp to output callback");
  const auto& latency = table.percentiles.at("input to output callback");
  const auto& work = table.percentiles.at("the nodelet's own work");
  for (std::size_t i = 0; i < age.size(); ++i)
  {
    EXPECT_GE(age[i], latency[i] - 0.02) << i;  // two clocks, and a stamp in whole microseconds
    EXPECT_GE(latency[i], work[i]) << i;
  }
}

class Latency : public Graph
{
protected:
  Latency() { std::filesystem::create_directories(folder_); }
  ~Latency() override
  {
    loader_.clear();
    std::filesystem::remove_all(folder_);
  }

  static std::string read(const std::filesystem::path& path)
  {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string readReport() const { return read(report_); }

  /// Runs the launch file beside this process, and returns the exit code.
  int launch(const std::string& arguments) const
  {
    const std::string command =
        "timeout 100 roslaunch lidar_panoptic_clustering latency.launch report:=" + report_.string() + " " + arguments +
        " > " + printed_.string() + " 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("lidar_panoptic_latency_" + std::to_string(getpid()));
  const std::filesystem::path report_ = folder_ / "report.txt", printed_ = folder_ / "printed.txt";
};

TEST_F(Latency, LaunchFileMeasuresOneManagerAndTwoProcessesAndEnds)
{
  if (kSanitized) GTEST_SKIP() << "the nodelet manager of the system lacks the sanitizer's runtime";
  for (const auto& [separate, graph] : {std::pair("false", "one manager"), std::pair("true", "across processes")})
  {
    SCOPED_TRACE(graph);
    std::filesystem::remove(report_);
    EXPECT_EQ(launch(std::string("sensor:=vlp16 algorithm:=depth frames:=10 warm_up:=3 rate:=20 scans:=2 separate:=") +
                     separate),
              0)
        << read(printed_);
    const Table table = parse(readReport());
    EXPECT_EQ(table.graph, graph);
    EXPECT_EQ(table.algorithm, "depth");
    EXPECT_EQ(table.scans, 10U);
    expectPlausible(table);
    EXPECT_EQ(table.last_line, "done: 10 of 10 scans");
  }
}

TEST_F(Latency, LaunchFileEndsWhereAParameterIsRefused)
{
  if (kSanitized) GTEST_SKIP() << "the nodelet manager of the system lacks the sanitizer's runtime";
  launch("sensor:=vlp16 frames:=-1");
  EXPECT_NE(read(printed_).find("'frames': expected a whole number from 0 to 100000, got -1"), std::string::npos);
  EXPECT_EQ(readReport(), "");
}

/// Without a limit the report comes when the nodelet is unloaded.
TEST_F(Latency, MeasuresNodeletsOfItsOwnProcess)
{
  const std::string repeater = newName(), clusterer = newName(), latency = newName();
  const auto source = advertise<LabelledCloud>(repeater + "/input");
  ros::param::set(repeater + "/rate_hz", 50.0);
  ros::param::set(repeater + "/scans", 1);
  ros::param::set(latency + "/frames", 0);
  ros::param::set(latency + "/warm_up", 2);
  ros::param::set(latency + "/report", report_.string());
  ASSERT_TRUE(tryLoad(repeater, "ScanRepeaterNodelet"));
  ASSERT_TRUE(tryLoad(clusterer, "DepthClusterNodelet", {{clusterer + "/input", repeater + "/output"}}));
  ASSERT_TRUE(tryLoad(latency, "LatencyNodelet",
                      {{latency + "/input", repeater + "/output"},
                       {latency + "/output", clusterer + "/output"},
                       {latency + "/stages", clusterer + "/stages"}}));
  waitForSubscriber(source);
  source.publish(share(labelledScene()));
  // there are none before the nodelet listens to the output
  Probe<diagnostic_msgs::DiagnosticArray> stages(clusterer + "/stages");
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(stages.next()) << i;
  EXPECT_EQ(readReport(), "");
  loader_.unload(latency);
  const Table table = parse(readReport());
  EXPECT_EQ(table.graph, "one manager");
  EXPECT_EQ(table.algorithm, "depth");
  EXPECT_GE(table.scans, 3U);
  expectPlausible(table);
  EXPECT_EQ(table.last_line, "done: ended from outside, as no number of scans was set");
}

TEST_F(Latency, RepeaterPublishesTheScansItGotOneByOneWithNewStamps)
{
  const std::string repeater = newName();
  const auto source = advertise<LabelledCloud>(repeater + "/input");
  ros::param::set(repeater + "/rate_hz", 50.0);
  ros::param::set(repeater + "/scans", 2);
  ASSERT_TRUE(tryLoad(repeater, "ScanRepeaterNodelet"));
  Probe<LabelledCloud> output(repeater + "/output");
  waitForSubscriber(source);
  LabelledCloud scan = labelledScene();
  source.publish(share(scan));
  ros::WallDuration(0.2).sleep();
  EXPECT_FALSE(output.takeIfThere()) << "it has one of two scans";
  scan.points[0] = labelled(1.0F, 2.0F, 3.0F, kCar);
  source.publish(share(scan));
  EXPECT_TRUE(eventually([&] { return source.getNumSubscribers() == 0; })) << "it has all it needs";

  std::uint64_t last_stamp = labelledScene().header.stamp;
  std::set<const LabelledCloud*> clouds;
  std::vector<Probe<LabelledCloud>::Ptr> kept;
  for (int i = 0; i < 5; ++i)
  {
    const auto cloud = output.next();
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->points[0].label == kCar && cloud->points[0].y == 2.0F, i % 2 == 1) << i;
    EXPECT_EQ(cloud->size(), scan.size());
    EXPECT_EQ(cloud->header.frame_id, scan.header.frame_id);
    EXPECT_GT(cloud->header.stamp, last_stamp);
    last_stamp = cloud->header.stamp;
    kept.push_back(cloud);
    clouds.insert(cloud.get());
  }
  EXPECT_EQ(clouds.size(), kept.size()) << "each is a cloud of its own";
}

TEST_F(Latency, RefusesWhatItCannotDo)
{
  const auto refused =
      [this](const std::string& type, const std::string& parameter, auto value, const std::string& reason)
  {
    const std::string name = newName();
    ros::param::set(name + "/" + parameter, value);
    LogProbe log;
    EXPECT_FALSE(tryLoad(name, type)) << parameter;
    const std::string message = log.waitFor("not loaded");
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  };
  refused("LatencyNodelet", "frames", -1, "'frames': expected a whole number from 0 to 100000, got -1");
  refused("LatencyNodelet", "warm_up", std::string("few"), "warm_up");
  refused("LatencyNodelet", "timeout_s", 0.0, "'timeout_s': expected a number from 0.1 to 3600, got 0");
  refused("LatencyNodelet", "report", std::string("/no/such/folder/report"), "/no/such/folder/report");
  refused("ScanRepeaterNodelet", "rate_hz", 0.0, "'rate_hz': expected a number from 0.01 to 1000, got 0");
  refused("ScanRepeaterNodelet", "scans", 0, "'scans': expected a whole number from 1 to 1000, got 0");
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "latency_test");
}
