#include "tools/support/aside_file.h"
#include "tools/support/benchmark_charts.h"
#include "tools/support/benchmark_figure.h"
#include "tools/support/run_benchmark.h"

#include <sys/ioctl.h>
#include <boost/program_options.hpp>

#include <cstdlib>
#include <iostream>

namespace po = boost::program_options;
namespace fs = std::filesystem;
using namespace lidar_panoptic_clustering;

namespace
{
constexpr const char* kUsage =
    R"(Quality and speed of clustering algorithms on SemanticKITTI, all on the same semantics.

  panoptic_benchmark --dataset DIR [options]
  panoptic_benchmark --merge a.json b.json .. [--report FILE.json] [--plot DIR]
  panoptic_benchmark --compare a.json b.json ..

Reads each scan once, runs every row (an algorithm with one setting) on it, gives all thing points an instance, those
hidden in the range image too, and compares with the ground truth by the rules of the official evaluator. Ctrl-C ends
with the figures so far. Errors go to stderr and make the exit status 1, an interrupt 130.

Examples:
  panoptic_benchmark --dataset kitti/dataset --split valid --semantics results/cylinder3d
  panoptic_benchmark --dataset kitti/dataset --sequences 00,05 --algorithms depth --set depth.theta_deg=5,8,10,12

Options)";

po::options_description describeOptions()
{
  po::options_description options(kUsage, 110, 60);
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  const auto list = [](const char* name) { return po::value<std::vector<std::string>>()->value_name(name); };
  const auto number = [](int value) { return po::value<int>()->value_name("N")->default_value(value); };
  options.add_options()("help,h", "this text");
  options.add_options()("dataset", text("DIR"), "folder that holds sequences/SS/{velodyne,labels}");
  options.add_options()("sequences", text("00,05"), "sequences to run on; otherwise all of the data set with labels");
  options.add_options()("split", text("NAME"), "train, valid (sequence 08) or test instead of --sequences");
  options.add_options()(
      "semantics", text("DIR"),
      "folder that holds sequences/SS/predictions, a network's classes; otherwise the ground truth's");
  options.add_options()("algorithms", text("A,B"),
                        "algorithms to run; otherwise all (supervoxel twice, without and with normals)");
  options.add_options()("survey", "the settings of Zhao et al. 2021: no class sizes, no refinement");
  options.add_options()("set", list("A.P=V,V ..")->multitoken()->composing(),
                        "sets parameter P of algorithm A; several values, or several parameters, give a row each");
  options.add_options()("switches",
                        "also each row with no step of the refinement, with each alone, and with all but each");
  options.add_options()("jobs", number(1),
                        "threads, each on scans of its own; the quality does not depend on it, but times are best "
                        "taken with one");
  options.add_options()("shard", text("I/N")->default_value("1/1"), "every N-th scan, beginning with the I-th");
  options.add_options()("limit", number(0), "the first N scans of each sequence; 0: all");
  options.add_options()("output", text("DIR"),
                        "write ROW/sequences/SS/predictions/NNNNNN.label; a later run goes on where this one stops");
  options.add_options()("report", text("FILE.json"), "write all figures and what is needed to merge them");
  options.add_options()("plot", text("DIR"), "write charts, and a figure of each sequence's worst scan");
  options.add_options()("class-table", text("FILE"),
                        "YAML file, or the name of a table that ships with the package (default: semantic_kitti)");
  options.add_options()("columns", number(2048), "of the range image");
  options.add_options()("keep-going", "skip scans that cannot be used and count them in the report");
  options.add_options()("merge", list("FILE.json ..")->multitoken(), "add up the reports of shards");
  options.add_options()("compare", list("FILE.json ..")->multitoken(),
                        "print PQ of things of reports of the same rows side by side");
  return options;
}

std::string textOf(const po::variables_map& given, const char* option)
{
  return given.count(option) == 0 ? "" : given[option].as<std::string>();
}

std::vector<std::string> listOf(const po::variables_map& given, const char* option)
{
  return given.count(option) == 0 ? std::vector<std::string>{} : given[option].as<std::vector<std::string>>();
}

int numberOf(const po::variables_map& given, const char* option, int min, int max)
{
  const int value = given[option].as<int>();
  if (value < min || value > max)
    throw std::invalid_argument("--" + std::string(option) + " is " + std::to_string(value) + ", expected " +
                                std::to_string(min) + " to " + std::to_string(max));
  return value;
}

void readShard(const std::string& text, BenchmarkSettings& settings)
{
  int end = 0;
  const bool read = std::sscanf(text.c_str(), "%d/%d%n", &settings.shard, &settings.shards, &end) == 2;
  if (!read || static_cast<std::size_t>(end) != text.size() || settings.shard < 1 || settings.shard > settings.shards)
    throw std::invalid_argument("--shard is '" + text + "', expected I/N with I from 1 to N");
}

BenchmarkSettings readSettings(const po::variables_map& given)
{
  BenchmarkSettings settings;
  settings.dataset = textOf(given, "dataset");
  if (settings.dataset.empty()) throw std::invalid_argument("--dataset is missing; see --help");
  if (given.count("sequences") != 0 && given.count("split") != 0)
    throw std::invalid_argument("--sequences and --split exclude each other");
  if (given.count("sequences") != 0) settings.sequences = splitAtCommas(textOf(given, "sequences"), "--sequences");
  if (given.count("split") != 0) settings.sequences = semanticKittiSplit(textOf(given, "split"));
  settings.semantics = fs::path(textOf(given, "semantics")).lexically_normal().string();
  if (given.count("class-table") != 0) settings.class_table = textOf(given, "class-table");
  std::vector<std::string> algorithms;
  if (given.count("algorithms") != 0) algorithms = splitAtCommas(textOf(given, "algorithms"), "--algorithms");
  if (given.count("switches") != 0 && given.count("survey") != 0)
    throw std::invalid_argument("--switches and --survey exclude each other: the survey has no refinement");
  settings.rows = makeRows(algorithms, listOf(given, "set"), given.count("survey") != 0, given.count("switches") != 0);
  settings.output = textOf(given, "output");
  settings.jobs = numberOf(given, "jobs", 1, 1024);
  readShard(textOf(given, "shard"), settings);
  settings.limit = numberOf(given, "limit", 0, 1 << 30);
  settings.columns = numberOf(given, "columns", 16, 16384);
  settings.keep_going = given.count("keep-going") != 0;
  return settings;
}

/// Of the terminal; 0 where standard output is none.
std::size_t terminalWidth()
{
  winsize size{};
  return isatty(STDOUT_FILENO) == 1 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

/// The table goes first, so that a full disk cannot take the figures along.
void publish(const BenchmarkReport& report, std::optional<AsideFile>& file, const std::string& plot)
{
  std::cout << formatBenchmark(report, terminalWidth()) << std::flush;
  if (!std::cout) throw std::runtime_error("cannot write the table to standard output");
  if (file) file->save(report.toJsonText());
  if (!plot.empty()) drawBenchmarkCharts(report, plot);
}

std::string readText(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read report " + path + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<BenchmarkReport> loadReports(const po::variables_map& given, const char* option)
{
  if (given.count("dataset") != 0)
    throw std::invalid_argument("--" + std::string(option) + " takes reports, not --dataset");
  std::vector<BenchmarkReport> reports;
  for (const std::string& path : listOf(given, option))
  {
    const std::string text = readText(path);
    const bool table_given = given.count("class-table") != 0;
    const std::string name = table_given ? textOf(given, "class-table") : BenchmarkReport::classTableOf(text, path);
    const auto table = std::make_shared<const ClassTable>(ClassTable::load(name));
    reports.push_back(BenchmarkReport::fromJsonText(text, path, table));
  }
  return reports;
}

BenchmarkReport merge(const po::variables_map& given)
{
  std::vector<BenchmarkReport> reports = loadReports(given, "merge");
  for (std::size_t i = 1; i < reports.size(); ++i) reports[0] += reports[i];
  return std::move(reports[0]);
}

void compare(const po::variables_map& given)
{
  std::vector<std::string> headings;
  for (const std::string& path : listOf(given, "compare")) headings.push_back(fs::path(path).stem().string());
  std::cout << formatComparison(loadReports(given, "compare"), headings) << std::flush;
  if (!std::cout) throw std::runtime_error("cannot write the table to standard output");
}

void drawWorstScans(const BenchmarkSettings& settings, const BenchmarkRun& run,
                    const std::shared_ptr<const ClassTable>& table, const fs::path& folder)
{
  for (const std::size_t i : run.worstScans())
    drawBenchmarkFigure(settings, run.scans(), i, table,
                        folder / ("scan_" + run.scans().sequence(i) + "_" + run.scans().scanName(i) + ".png"));
}

/// Exit status.
int run(const po::variables_map& given)
{
  if (given.count("compare") != 0)
  {
    compare(given);
    return EXIT_SUCCESS;
  }
  const std::string plot = textOf(given, "plot");
  const bool merging = given.count("merge") != 0;
  const BenchmarkSettings settings = merging ? BenchmarkSettings{} : readSettings(given);
  std::optional<AsideFile> file;
  if (given.count("report") != 0) file.emplace(textOf(given, "report"));
  if (!plot.empty()) fs::create_directories(plot);
  if (merging)
  {
    publish(merge(given), file, plot);
    return EXIT_SUCCESS;
  }

  const auto table = std::make_shared<const ClassTable>(ClassTable::load(settings.class_table));
  BenchmarkRun benchmark(settings, table);
  noteInterrupts();
  publish(benchmark.run(), file, plot);
  if (interrupted() != 0)
  {
    std::cerr << "panoptic_benchmark: interrupted; the figures are of the scans done by then\n";
    return 128 + interrupted();
  }
  if (!plot.empty()) drawWorstScans(settings, benchmark, table, plot);
  return EXIT_SUCCESS;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const auto options = describeOptions();
    po::variables_map given;
    // no abbreviations: a later option must not change what a script means
    const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(argc, argv)
                  .options(options)
                  .positional(po::positional_options_description())
                  .style(style)
                  .run(),
              given);
    if (given.count("help") == 0) return run(given);
    std::cout << options;
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << "panoptic_benchmark: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
