#include "core/aside_file.h"
#include "tools/support/benchmark_figure.h"
#include "tools/support/benchmark_options.h"
#include "tools/support/plot_report.h"
#include "tools/support/program.h"
#include "tools/support/run_benchmark.h"
#include "tools/support/run_without_labels.h"

#include <sys/ioctl.h>

namespace fs = std::filesystem;
using namespace lidar_panoptic_clustering;

namespace
{
constexpr const char* kUsage =
    R"(Quality and speed of clustering algorithms on SemanticKITTI, all on the same semantics.

  panoptic_benchmark --dataset DIR [options]
  panoptic_benchmark --dataset DIR --labels none [options]
  panoptic_benchmark --merge a.json b.json .. [--report FILE.json] [--plot DIR]
  panoptic_benchmark --compare a.json b.json ..

Reads each scan once, runs every row (an algorithm with one setting) on it, gives all thing points an instance, those
hidden in the range image too, and compares with the ground truth by the rules of the official evaluator. Ctrl-C ends
with the figures so far. With --labels none no classes are used: the whole chain works on the points alone, and its
objects are compared with the true ones whatever their class. Errors go to stderr and make the exit status 1, an interrupt 130.

Examples:
  panoptic_benchmark --dataset kitti/dataset --split valid --semantics results/cylinder3d
  panoptic_benchmark --dataset kitti/dataset --sequences 00,05 --algorithms depth --set depth.theta_deg=5,8,10,12

Options)";

Options describeOptions()
{
  Options options = describeProgram(kUsage);
  for (const BenchmarkOption& one : kBenchmarkOptions) switch (one.kind)
    {
      case OptionKind::kFlag:
        options.add_options()(one.name, one.text);
        break;
      case OptionKind::kText:
        options.add_options()(one.name, textValue(one.value), one.text);
        break;
      case OptionKind::kList:
        options.add_options()(one.name, textValues(one.value)->composing(), one.text);
        break;
      case OptionKind::kNumber:
        options.add_options()(one.name, numberValue(one.number), one.text);
        break;
    }
  options.add_options()("jobs", numberValue(1),
                        "threads, each on scans of its own; the quality does not depend on it, but times are best "
                        "taken with one");
  options.add_options()("shard", textValue("I/N")->default_value("1/1"), "every N-th scan, beginning with the I-th");
  options.add_options()("report", textValue("FILE.json"), "write all figures and what is needed to merge them");
  options.add_options()("plot", textValue("DIR"),
                        "write charts (by Python's matplotlib), and a figure of each sequence's worst scan; with "
                        "--labels none figures of the ten worst scans, truth beside result, with the objects that were "
                        "lost or merged marked");
  options.add_options()("labels", textValue("none", "classes"),
                        "classes, or none: objects by geometry alone, against the true objects of all classes");
  options.add_options()("keep-rings", numberValue(1), "with --labels none: every N-th ring, a sensor of fewer beams");
  options.add_options()("shuffle", "with --labels none: the points without an order, as of a lidar without scan lines");
  options.add_options()("structure", textValue("balanced", "balanced"),
                        "with --labels none: strict, balanced or keep_objects");
  options.add_options()("merge", textValues("FILE.json .."), "add up the reports of shards");
  options.add_options()("compare", textValues("FILE.json .."),
                        "print PQ of things of reports of the same rows side by side");
  return options;
}

void readShard(const std::string& text, BenchmarkSettings& settings)
{
  int end = 0;
  const bool read = std::sscanf(text.c_str(), "%d/%d%n", &settings.shard, &settings.shards, &end) == 2;
  if (!read || static_cast<std::size_t>(end) != text.size() || settings.shard < 1 || settings.shard > settings.shards)
    throw std::invalid_argument("--shard is '" + text + "', expected I/N with I from 1 to N");
}

BenchmarkSettings readSettings(const Given& given)
{
  GivenOptions options;
  for (const BenchmarkOption& one : kBenchmarkOptions)
  {
    if (!isGiven(given, one.name)) continue;
    std::vector<std::string>& values = options[one.name];
    if (one.kind == OptionKind::kText) values = {textOf(given, one.name)};
    if (one.kind == OptionKind::kList) values = listOf(given, one.name);
    if (one.kind == OptionKind::kNumber) values = {std::to_string(given[one.name].as<int>())};
  }
  BenchmarkSettings settings = readBenchmarkOptions(options);
  settings.jobs = numberOf(given, "jobs", 1, 1024);
  readShard(textOf(given, "shard"), settings);
  if (settings.track && settings.shards > 1)
    throw std::invalid_argument("--track needs every scan of a sequence, --shard gives every " +
                                std::to_string(settings.shards) + "th: divide by --sequences instead");
  return settings;
}

/// Of the terminal; 0 where standard output is none.
std::size_t terminalWidth()
{
  winsize size{};
  return isatty(STDOUT_FILENO) == 1 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

/// The table goes first, so that a full disk cannot take the figures along.
void publish(const BenchmarkReport& report, std::optional<AsideFile>& file)
{
  printResult(formatBenchmark(report, terminalWidth()));
  if (file) file->save(report.toJsonText());
}

std::vector<BenchmarkReport> loadReports(const Given& given, const char* option)
{
  if (isGiven(given, "dataset"))
    throw std::invalid_argument("--" + std::string(option) + " takes reports, not --dataset");
  std::vector<BenchmarkReport> reports;
  for (const std::string& path : listOf(given, option))
  {
    const std::string text = readTextFile(path, kMaxReport);
    const bool table_given = isGiven(given, "class-table");
    const std::string name = table_given ? textOf(given, "class-table") : BenchmarkReport::classTableOf(text, path);
    const auto table = std::make_shared<const ClassTable>(ClassTable::load(name));
    reports.push_back(BenchmarkReport::fromJsonText(text, path, table));
  }
  return reports;
}

BenchmarkReport merge(const Given& given)
{
  std::vector<BenchmarkReport> reports = loadReports(given, "merge");
  for (std::size_t i = 1; i < reports.size(); ++i) reports[0] += reports[i];
  return std::move(reports[0]);
}

void compare(const Given& given)
{
  std::vector<std::string> headings;
  for (const std::string& path : listOf(given, "compare")) headings.push_back(fs::path(path).stem().string());
  printResult(formatComparison(loadReports(given, "compare"), headings));
}

void drawWorstScans(const BenchmarkSettings& settings, const BenchmarkRun& run,
                    const std::shared_ptr<const ClassTable>& table, const fs::path& folder)
{
  for (const std::size_t i : run.worstScans())
    drawBenchmarkFigure(settings, run.scans(), i, table,
                        folder / ("scan_" + run.scans().sequence(i) + "_" + run.scans().scanName(i) + ".png"));
}

/// Exit status.
int runWithoutLabels(const Given& given)
{
  for (const char* option : {"semantics", "survey", "switches", "report", "merge", "keep-going"})
    if (isGiven(given, option))
      throw std::invalid_argument("--labels none and --" + std::string(option) + " exclude each other");
  BenchmarkSettings settings = readSettings(given);
  if (settings.jobs != 1) throw std::invalid_argument("--labels none runs in one thread, found --jobs");
  if (!isGiven(given, "algorithms")) settings.rows = makeRows({"birds_eye"}, listOf(given, "set"));
  WithoutLabels without;
  without.keep_rings = numberOf(given, "keep-rings", 1, 64);
  without.shuffle = isGiven(given, "shuffle");
  without.structure = textOf(given, "structure");
  without.plot = textOf(given, "plot");
  noteInterrupts();
  RunWithoutLabels benchmark(settings, without,
                             std::make_shared<const ClassTable>(ClassTable::load(settings.class_table)));
  printResult(benchmark.run());
  return interrupted() == 0 ? EXIT_SUCCESS : 128 + interrupted();
}

/// Exit status.
int run(const Given& given)
{
  if (textOf(given, "labels") == "none") return runWithoutLabels(given);
  if (textOf(given, "labels") != "classes")
    throw std::invalid_argument("--labels is '" + textOf(given, "labels") + "', expected classes or none");
  if (isGiven(given, "compare"))
  {
    compare(given);
    return EXIT_SUCCESS;
  }
  const std::string plot = textOf(given, "plot");
  const bool merging = isGiven(given, "merge");
  const BenchmarkSettings settings = merging ? BenchmarkSettings{} : readSettings(given);
  if (!plot.empty()) fs::create_directories(plot);
  const std::string path = isGiven(given, "report") || plot.empty() ? textOf(given, "report") : plot + "/report.json";
  std::optional<AsideFile> file;
  if (!path.empty()) file.emplace(path);
  if (merging)
  {
    publish(merge(given), file);
    if (!plot.empty()) plotReport(path, plot);
    return EXIT_SUCCESS;
  }

  const auto table = std::make_shared<const ClassTable>(ClassTable::load(settings.class_table));
  BenchmarkRun benchmark(settings, table);
  noteInterrupts();
  publish(benchmark.run(), file);
  if (interrupted() != 0)
    std::cerr << "panoptic_benchmark: interrupted; the figures are of the scans done by then\n";
  else if (!plot.empty())
    drawWorstScans(settings, benchmark, table, plot);
  if (!plot.empty()) plotReport(path, plot);
  return interrupted() == 0 ? EXIT_SUCCESS : 128 + interrupted();
}
}  // namespace

int main(int argc, char** argv)
{
  return runProgram("panoptic_benchmark", argc, argv, describeOptions(), run);
}
