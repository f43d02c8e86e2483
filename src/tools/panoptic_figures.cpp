// Draws the pictures of the documentation.
#include "lidar_panoptic_clustering/drawing/street_picture.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "tools/support/figure_scan.h"
#include "tools/support/program.h"
#include "tools/support/step_figures.h"

#include <filesystem>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr char kUsage[] =
    "Usage: panoptic_figures --output DIR [OPTION...]\n\n"
    "Draws the pictures of the documentation into DIR: street.png, a simulated street with its objects; "
    "algorithms.png,\n"
    "all algorithms on one scene; step_*.png, what each step of the refinement does to it. The same options give the\n"
    "same pictures.\n\nOptions";

Options describeOptions()
{
  Options options = describeProgram(kUsage);
  options.add_options()("output", textValue("DIR"), "where the pictures go; made where it is missing");
  options.add_options()("algorithm", textValue("NAME", "birds_eye"), "of the street and of the steps");
  options.add_options()("sensor", textValue("NAME", "os1_128"),
                        "of the street: a sensor file that ships, or a YAML file");
  options.add_options()("seed", numberValue(2), "which street");
  options.add_options()("frame", numberValue(4), "which moment of it, in tenths of a second");
  return options;
}

/// The street as a driver sees it from above and behind.
void drawStreet(const Given& given, const std::string& path)
{
  SimulatorConfig config;
  config.seed = numberOf(given, "seed", 0, 1000000);
  config.noise_scale = 0.5;
  config.parking_density = 0.9, config.pedestrian_density = 0.9, config.traffic_density = 0.8;
  SensorModel model = SensorModel::load(textOf(given, "sensor"));
  model.columns *= 2;  // a picture may be denser than a scan at 10 Hz
  LidarSimulator simulator(model, config);
  PanopticCloud truth;
  simulator.scan(static_cast<std::uint64_t>(numberOf(given, "frame", 0, 1000000)), truth);
  constexpr std::uint32_t kFewest = 30;
  const FigureScan scan = clusterForFigure(withoutInstances(truth), textOf(given, "algorithm"), {}, kFewest);
  StreetPictureOptions options;
  options.camera = {-11.5, 1.65, 7.5, 13.0, 1.0, -0.8, 66.0};
  drawStreetPicture(scan.cloud, scan.boxes, path, options);
}

int run(const Given& given)
{
  const std::string folder = required(given, "output"), algorithm = textOf(given, "algorithm");
  std::filesystem::create_directories(folder);
  drawStreet(given, folder + "/street.png");
  drawAlgorithmFigure(folder);
  drawStepFigures(folder, algorithm);
  return EXIT_SUCCESS;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runProgram("panoptic_figures", argc, argv, describeOptions(), run);
}
