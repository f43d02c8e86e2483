#include "python/benchmark_parts.h"
#include "python/bindings.h"

#include <pybind11/stl.h>

#include <tuple>

namespace py = pybind11;

namespace lidar_panoptic_clustering
{
namespace
{
py::dict toDict(const SequenceBenchmark::Result& result)
{
  py::dict dict;
  dict["report"] = py::bytes(result.report);
  dict["used"] = result.used;
  dict["resumed"] = result.resumed;
  dict["skipped"] = result.skipped;
  return dict;
}

py::dict run(SequenceBenchmark& benchmark, std::size_t begin, std::size_t end)
{
  SequenceBenchmark::Result result;
  {
    py::gil_scoped_release release;
    result = benchmark.run(begin, end);
  }
  return toDict(result);
}

/// (name, kind, value's name, default, help) of each.
std::vector<std::tuple<std::string, std::string, std::string, int, std::string>> options()
{
  static constexpr const char* kKinds[] = {"flag", "text", "list", "number"};
  std::vector<std::tuple<std::string, std::string, std::string, int, std::string>> result;
  for (const BenchmarkOption& one : kBenchmarkOptions)
    result.emplace_back(one.name, kKinds[static_cast<int>(one.kind)], one.value, one.number, one.text);
  return result;
}

std::vector<std::string> rowsOf(const BenchmarkPlan& plan)
{
  std::vector<std::string> names;
  for (const RowSettings& row : plan.settings().rows) names.push_back(row.name);
  return names;
}
}  // namespace

void bindBenchmark(py::module& module)
{
  using Released = py::call_guard<py::gil_scoped_release>;
  py::class_<BenchmarkPlan>(module, "BenchmarkPlan",
                            "What panoptic_benchmark's options ask for; what workers agree on.")
      .def(
          py::init<const GivenOptions&, bool>(), py::arg("options"), py::arg("label") = false, Released(),
          "options: values by name, of a flag none. label: predictions of one algorithm into --output, no evaluation.\n"
          "Raises ValueError naming the option, RuntimeError where there is no such data set.")
      .def_static("options", &options,
                  "(name, kind, value's name, default, help) of each option; kind is flag, text,\n"
                  "list or number.")
      .def_property_readonly("sequences", &BenchmarkPlan::sequences, "Names, in the order of the run.")
      .def_property_readonly("rows", &rowsOf, "Names of the table's rows.")
      .def_property_readonly("track", [](const BenchmarkPlan& plan) { return plan.settings().track; })
      .def_property_readonly("keep_going", [](const BenchmarkPlan& plan) { return plan.settings().keep_going; });
  py::class_<SequenceBenchmark>(module, "SequenceBenchmark", "One sequence of a plan, of which parts are run.")
      .def(py::init<const BenchmarkPlan&, const std::string&>(), py::arg("plan"), py::arg("sequence"), Released(),
           "Raises RuntimeError naming the folder or file that is wrong.")
      .def("__len__", &SequenceBenchmark::size, "Number of scans.")
      .def("scan_name", &SequenceBenchmark::scanName, py::arg("scan"), "Its file name without the ending.")
      .def_property_readonly("skipped", &SequenceBenchmark::skipped, "(scan, reason) of predictions without a scan.")
      .def("run", &run, py::arg("begin"), py::arg("end"),
           "Runs scans begin..end - 1: a dict of report (bytes, for BenchmarkSum.add), used and resumed (numbers of\n"
           "scans) and skipped ((scan, reason)). Raises RuntimeError naming the scan's file. The GIL is released.");
  py::class_<BenchmarkSum>(module, "BenchmarkSum", "Adds up reports of parts, in any order.")
      .def(py::init<const BenchmarkPlan&>(), py::arg("plan"))
      .def(
          "add", [](BenchmarkSum& sum, const py::bytes& report) { sum.add(report); }, py::arg("report"),
          "Raises ValueError where it is no part of the plan's benchmark, or was added before.")
      .def("skip", &BenchmarkSum::skip, py::arg("scan"), py::arg("reason"), "A scan that could not be used.")
      .def(
          "table",
          [](BenchmarkSum& sum, bool interrupted, std::size_t width)
          { return formatBenchmark(sum.total(interrupted), width); },
          py::arg("interrupted"), py::arg("width"), "panoptic_benchmark's tables; width 0 is any.")
      .def(
          "json", [](BenchmarkSum& sum, bool interrupted) { return py::bytes(sum.total(interrupted).toJsonText()); },
          py::arg("interrupted"), "panoptic_benchmark's report.");
}
}  // namespace lidar_panoptic_clustering
