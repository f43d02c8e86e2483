#include "core/aside_file.h"
#include "tools/support/evaluate_predictions.h"
#include "tools/support/program.h"

#include <optional>

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

Options describeOptions()
{
  const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  Options options = describeProgram(kUsage);
  options.add_options()("dataset", textValue("DIR"), "folder that holds sequences/SS/labels");
  options.add_options()("predictions", textValue("DIR"), "folder that holds sequences/SS/predictions");
  options.add_options()("sequences", textValue("00,05"),
                        "sequences to evaluate; otherwise all of the data set that have labels");
  options.add_options()("split", textValue("NAME"), "train, valid (sequence 08) or test instead of --sequences");
  options.add_options()("class-table", textValue("FILE"),
                        "YAML file, or the name of a table that ships with the package (semantic_kitti, which is the "
                        "default, or nuscenes)");
  options.add_options()("min-points", numberValue(50), "unmatched segments with fewer points do not count");
  options.add_options()("jobs", numberValue(cores), "threads; the result does not depend on it");
  options.add_options()("keep-going", "skip scans that cannot be evaluated and count them in the report");
  options.add_options()("report", textValue("FILE.json"), "write the figures and all that is needed to merge them");
  options.add_options()("merge", textValues("FILE.json .."), "add up reports instead of evaluating");
  return options;
}

std::shared_ptr<const ClassTable> loadTable(const std::string& name)
{
  return std::make_shared<const ClassTable>(ClassTable::load(name));
}

EvaluationReport evaluate(const Given& given)
{
  PredictionSet set;
  set.dataset = required(given, "dataset");
  set.predictions = required(given, "predictions");
  if (isGiven(given, "sequences") && isGiven(given, "split"))
    throw std::invalid_argument("--sequences and --split exclude each other");
  if (isGiven(given, "sequences")) set.sequences = splitAtCommas(textOf(given, "sequences"), "--sequences");
  if (isGiven(given, "split")) set.sequences = semanticKittiSplit(textOf(given, "split"));
  set.min_points = given["min-points"].as<int>();
  set.jobs = given["jobs"].as<int>();
  set.keep_going = isGiven(given, "keep-going");
  return evaluatePredictions(
      set, loadTable(isGiven(given, "class-table") ? textOf(given, "class-table") : "semantic_kitti"));
}

EvaluationReport merge(const Given& given)
{
  if (isGiven(given, "dataset") || isGiven(given, "predictions"))
    throw std::invalid_argument("--merge takes reports, not --dataset and --predictions");
  std::optional<EvaluationReport> sum;
  for (const std::string& path : listOf(given, "merge"))
  {
    const std::string text = readTextFile(path, kMaxReport);
    const auto table = loadTable(isGiven(given, "class-table") ? textOf(given, "class-table")
                                                               : EvaluationReport::classTableOf(text, path));
    auto report = EvaluationReport::fromJsonText(text, path, table);
    if (sum)
      *sum += report;
    else
      sum.emplace(std::move(report));
  }
  return *sum;
}

int run(const Given& given)
{
  std::optional<AsideFile> file;
  if (isGiven(given, "report")) file.emplace(textOf(given, "report"));
  const EvaluationReport report = isGiven(given, "merge") ? merge(given) : evaluate(given);
  if (file) file->save(report.toJsonText());
  printResult(formatReport(report));
  return EXIT_SUCCESS;
}
}  // namespace

int main(int argc, char** argv)
{
  return runProgram("panoptic_evaluate", argc, argv, describeOptions(), run);
}
