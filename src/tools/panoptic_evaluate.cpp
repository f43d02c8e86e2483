#include "tools/support/aside_file.h"
#include "tools/support/evaluate_predictions.h"

#include <boost/program_options.hpp>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>

namespace po = boost::program_options;
using namespace lidar_panoptic_clustering;

namespace
{
constexpr const char* kUsage = R"(Panoptic quality of predictions, by the rules of SemanticKITTI's official evaluator.

  panoptic_evaluate --dataset DIR --predictions DIR [options]
  panoptic_evaluate --merge a.json b.json .. [--report FILE.json]

DIR/sequences/SS/labels/NNNNNN.label of the data set is compared with DIR/sequences/SS/predictions/NNNNNN.label of the
predictions: a uint32 a point, class id in the low and instance in the high 16 bits, as many as the scan has points.
Prints a table; errors go to stderr and make the exit status 1.

Example: panoptic_evaluate --dataset kitti/dataset --predictions results --split valid --report results.json

Options)";

po::options_description describeOptions()
{
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  po::options_description options(kUsage, 110, 60);
  options.add_options()("help,h", "this text");
  options.add_options()("dataset", po::value<std::string>()->value_name("DIR"),
                        "folder that holds sequences/SS/labels");
  options.add_options()("predictions", po::value<std::string>()->value_name("DIR"),
                        "folder that holds sequences/SS/predictions");
  options.add_options()("sequences", po::value<std::string>()->value_name("00,05"),
                        "sequences to evaluate; otherwise all of the data set that have labels");
  options.add_options()("split", po::value<std::string>()->value_name("NAME"),
                        "train, valid (sequence 08) or test instead of --sequences");
  options.add_options()("class-table", po::value<std::string>()->value_name("FILE"),
                        "YAML file, or the name of a table that ships with the package (semantic_kitti, which is the "
                        "default, or nuscenes)");
  options.add_options()("min-points", po::value<int>()->value_name("N")->default_value(50),
                        "unmatched segments with fewer points do not count");
  options.add_options()("jobs", po::value<int>()->value_name("N")->default_value(cores),
                        "threads; the result does not depend on it");
  options.add_options()("keep-going", "skip scans that cannot be evaluated and count them in the report");
  options.add_options()("report", po::value<std::string>()->value_name("FILE.json"),
                        "write the figures and all that is needed to merge them");
  options.add_options()("merge", po::value<std::vector<std::string>>()->multitoken()->value_name("FILE.json .."),
                        "add up reports instead of evaluating");
  return options;
}

std::vector<std::string> splitAtCommas(const std::string& list)
{
  std::vector<std::string> names;
  std::istringstream in(list);
  for (std::string name; std::getline(in, name, ',');)
    if (!name.empty()) names.push_back(name);
  if (names.empty()) throw std::invalid_argument("--sequences names no sequence, expected 00,05");
  return names;
}

const std::string& required(const po::variables_map& given, const char* option)
{
  if (given.count(option) == 0) throw std::invalid_argument(std::string("--") + option + " is missing; see --help");
  return given[option].as<std::string>();
}

std::shared_ptr<const ClassTable> loadTable(const std::string& name)
{
  return std::make_shared<const ClassTable>(ClassTable::load(name));
}

EvaluationReport evaluate(const po::variables_map& given)
{
  PredictionSet set;
  set.dataset = required(given, "dataset");
  set.predictions = required(given, "predictions");
  if (given.count("sequences") != 0 && given.count("split") != 0)
    throw std::invalid_argument("--sequences and --split exclude each other");
  if (given.count("sequences") != 0) set.sequences = splitAtCommas(given["sequences"].as<std::string>());
  if (given.count("split") != 0) set.sequences = semanticKittiSplit(given["split"].as<std::string>());
  set.min_points = given["min-points"].as<int>();
  set.jobs = given["jobs"].as<int>();
  set.keep_going = given.count("keep-going") != 0;
  const bool table_given = given.count("class-table") != 0;
  return evaluatePredictions(set, loadTable(table_given ? given["class-table"].as<std::string>() : "semantic_kitti"));
}

std::string readText(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read report " + path + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(file), {}};
}

EvaluationReport merge(const po::variables_map& given)
{
  if (given.count("dataset") != 0 || given.count("predictions") != 0)
    throw std::invalid_argument("--merge takes reports, not --dataset and --predictions");
  std::optional<EvaluationReport> sum;
  for (const std::string& path : given["merge"].as<std::vector<std::string>>())
  {
    const std::string text = readText(path);
    const bool table_given = given.count("class-table") != 0;
    const auto table =
        loadTable(table_given ? given["class-table"].as<std::string>() : EvaluationReport::classTableOf(text, path));
    auto report = EvaluationReport::fromJsonText(text, path, table);
    if (sum)
      *sum += report;
    else
      sum.emplace(std::move(report));
  }
  return *sum;
}

void run(const po::variables_map& given)
{
  std::optional<AsideFile> file;
  if (given.count("report") != 0) file.emplace(given["report"].as<std::string>());
  const EvaluationReport report = given.count("merge") != 0 ? merge(given) : evaluate(given);
  if (file) file->save(report.toJsonText());
  std::cout << formatReport(report) << std::flush;
  if (!std::cout) throw std::runtime_error("cannot write the table to standard output");
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
    if (given.count("help") != 0)
      std::cout << options;
    else
      run(given);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << "panoptic_evaluate: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
