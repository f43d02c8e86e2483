// Measures tracking on simulated drives, whose ids and speeds are known exactly.
#include "core/plain_numbers.h"
#include "tools/support/program.h"
#include "tools/support/simulated_drive.h"

namespace lidar_panoptic_clustering
{
namespace
{
constexpr char kUsage[] =
    "Usage: panoptic_track_simulated [OPTION...]\n\n"
    "Drives down simulated streets, clusters the true classes, follows the objects, and prints a row a street: how "
    "many\n"
    "of the true objects that were seen with 20 points or more for a second kept one id all that time (gaps of up to "
    "a\n"
    "second included), how often ids changed, how many ids covered two true objects at some time, and the median "
    "error\n"
    "of vehicles' speeds within 40 m after a second of track.\n\nOptions";

Options describeOptions()
{
  Options options = describeProgram(kUsage);
  options.add_options()("sensor", textValue("NAME", "hdl32e"), "a sensor file that ships, or a YAML file");
  options.add_options()("algorithm", textValue("NAME", "birds_eye"), "or true: the exact instances");
  options.add_options()("first-seed", numberValue(1), "the first street");
  options.add_options()("seeds", numberValue(10), "how many streets");
  options.add_options()("seconds", numberValue(60), "of each drive, ten scans a second");
  return options;
}

std::string row(const std::string& name, const DriveFigures& figures)
{
  const double kept = 100.0 * static_cast<double>(figures.kept) / static_cast<double>(figures.objects);
  return name + "\t" + std::to_string(figures.objects) + "\t" + fixedText(kept, 1) + "\t" +
         std::to_string(figures.switches) + "\t" + std::to_string(figures.tracks) + "\t" +
         std::to_string(figures.shared) + "\t" + fixedText(medianOf(figures.moving), 3) + "\t" +
         fixedText(medianOf(figures.standing), 3) + "\n";
}

int run(const Given& given)
{
  DriveOptions options;
  options.sensor = textOf(given, "sensor"), options.algorithm = textOf(given, "algorithm");
  options.seconds = numberOf(given, "seconds", 2, 36000);
  const int first = numberOf(given, "first-seed", 0, 1000000), count = numberOf(given, "seeds", 1, 1000);
  printResult("seed\tobjects\tone id %\tswitches\ttracks\tof two\tmoving m/s\tstanding m/s\n");
  DriveFigures all;
  for (options.seed = first; options.seed < first + count; ++options.seed)
  {
    const DriveFigures figures = SimulatedDrive(options).run();
    printResult(row(std::to_string(options.seed), figures));
    all += figures;
  }
  printResult(row("all", all));
  return EXIT_SUCCESS;
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  using namespace lidar_panoptic_clustering;
  return runProgram("panoptic_track_simulated", argc, argv, describeOptions(), run);
}
