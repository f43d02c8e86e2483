#include "bags/sequence_bag.h"
#include "tools/support/program.h"
#include "tools/support/progress.h"

#include <cstdio>
#include <optional>

namespace po = boost::program_options;
using namespace lidar_panoptic_clustering;

namespace
{
constexpr const char* kUsage = R"(Writes a sequence of a SemanticKITTI folder as a rosbag file.

  semantickitti_to_bag --dataset DIR --sequence SS --output FILE.bag [options]

  /points        sensor_msgs/PointCloud2, the points in the file's order: x y z intensity, ring (0 the lowest beam) and
                 label (raw class id; true, or those of --semantics; no such field where there are neither)
  /ground_truth  sensor_msgs/PointCloud2, organised, with true classes and instances, where there are true labels
  /tf            world -> the sensor, where there are poses

All of a scan carry the time in times.txt. The file is written aside and renamed when it is whole. Errors go to stderr
and make the exit status 1.

Example: semantickitti_to_bag --dataset kitti/dataset --sequence 08 --output 08.bag --compression lz4
         rosbag play --clock 08.bag

Options)";

Options describeOptions()
{
  const SequenceBagConfig config;
  Options options = describeProgram(kUsage);
  options.add_options()("dataset", textValue("DIR"), "folder that holds sequences/SS/velodyne");
  options.add_options()("sequence", textValue("SS", config.sequence), "which of its sequences");
  options.add_options()("semantics", textValue("DIR", ""),
                        "take the points' classes from DIR/sequences/SS/predictions instead of the true ones");
  options.add_options()("label-table", textValue("FILE", ""),
                        "what their ids mean, e.g. semantic_kitti_training (default: the class table)");
  options.add_options()("output", textValue("FILE"), "the bag");
  options.add_options()("first", po::value<long>()->value_name("N")->default_value(0), "first scan");
  options.add_options()("count", po::value<long>()->value_name("N"), "how many scans; otherwise all from the first on");
  options.add_options()("compression", textValue("NAME", config.compression), "none, lz4 or bz2");
  options.add_options()("start",
                        po::value<double>()->value_name("SECONDS")->default_value(config.start_s, "1316995200"),
                        "the stamp of the sequence's time 0");
  options.add_options()("frame-id", textValue("NAME", config.frame_id), "the sensor's frame");
  options.add_options()("columns", numberValue(config.projection.columns), "width of the ground truth's range image");
  options.add_options()("class-table", textValue("FILE", config.class_table),
                        "which classes are things: a YAML file or the name of a table that ships with the package");
  return options;
}

std::uint64_t number(const Given& given, const char* option, long least)
{
  const long value = given[option].as<long>();
  if (value < least)
    throw std::invalid_argument(std::string("--") + option + ": expected " + std::to_string(least) +
                                " or more, found " + std::to_string(value));
  return static_cast<std::uint64_t>(value);
}

SequenceBagConfig configOf(const Given& given)
{
  SequenceBagConfig config;
  config.dataset = required(given, "dataset");
  config.output = required(given, "output");
  config.sequence = given["sequence"].as<std::string>();
  config.semantics = given["semantics"].as<std::string>();
  config.label_table = given["label-table"].as<std::string>();
  config.first = number(given, "first", 0);
  if (isGiven(given, "count")) config.count = number(given, "count", 1);
  config.compression = given["compression"].as<std::string>();
  config.start_s = given["start"].as<double>();
  config.frame_id = given["frame-id"].as<std::string>();
  config.projection.columns = given["columns"].as<int>();
  config.class_table = given["class-table"].as<std::string>();
  return config;
}

int run(const Given& given)
{
  const SequenceBagConfig config = configOf(given);
  noteInterrupts();
  std::optional<Progress> bar;
  const auto progress = [&bar](std::uint64_t done, std::uint64_t all)
  {
    if (done == 0)
      bar.emplace("semantickitti_to_bag", all);
    else
      bar->step();
    return interrupted() == 0;
  };
  const SequenceBagSummary summary = writeSequenceBag(config, progress);
  bar.reset();
  if (!summary.doubt.empty()) std::fprintf(stderr, "semantickitti_to_bag: %s\n", summary.doubt.c_str());
  std::printf("%s: %llu scans, %llu points, %.1f MB; labels: %s, ground truth: %s, tf: %s\n", config.output.c_str(),
              static_cast<unsigned long long>(summary.scans), static_cast<unsigned long long>(summary.points),
              static_cast<double>(summary.bytes) / 1e6, summary.labelled ? "yes" : "no",
              summary.ground_truth ? "yes" : "no", summary.poses ? "yes" : "no");
  return EXIT_SUCCESS;
}
}  // namespace

int main(int argc, char** argv)
{
  return runProgram("semantickitti_to_bag", argc, argv, describeOptions(), run);
}
