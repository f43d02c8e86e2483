#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/evaluation_report.h"
#include "python/bindings.h"
#include "python/dataset_reader.h"
#include "python/numpy_arrays.h"

#include <pybind11/stl.h>
#include <nlohmann/json.hpp>

#include <cstring>

namespace py = pybind11;

namespace lidar_panoptic_clustering
{
namespace
{
constexpr const char* kQualityDoc = R"(Panoptic quality by the rules of SemanticKITTI's official evaluator.

    quality = PanopticQuality()
    quality.add(encode_labels(labels, instances), truth)
    quality.figures()["pq"]

class_table: what the labels mean. min_points: unmatched segments of fewer points do not count.
Counts are sums: parts of a data set, added in any order with +=, equal the whole to the bit. May be pickled.
Kirillov et al. 2019; Behley et al. 2021. Raises ValueError on an unknown table and a negative min_points.)";

constexpr const char* kDatasetDoc =
    R"(A data set in SemanticKITTI's layout, dataset/sequences/SS/{velodyne,labels,poses.txt,calib.txt,times.txt}.

    kitti = SemanticKitti("/data/semantickitti", semantics="/data/my_network")
    for scan in kitti.scans("08"):
        points, labels = kitti.points("08", scan), kitti.classes("08", scan)

dataset: the folder that holds `sequences`. semantics: a folder with sequences/SS/predictions, a network's classes; none:
those of the ground truth. class_table: of the classes; label_table: of the ids in semantics where they are others.
A scan is its name ("000123") or its place (0, 1, ..). Errors are ValueError and name the file. May be used from several
threads; reading releases the GIL.)";

std::string pathOf(const py::object& path)
{
  return py::module::import("os").attr("fspath")(path).cast<std::string>();
}

/// A quality that knows where its class table came from, so that it can be pickled.
struct NamedQuality
{
  std::string class_table;
  PanopticQuality quality;
};

NamedQuality makeQuality(const std::string& class_table, int min_points)
{
  return withValueErrors(
      [&]
      {
        const auto table = std::make_shared<const ClassTable>(ClassTable::load(class_table));
        return NamedQuality{class_table, PanopticQuality(table, min_points)};
      });
}

void addScan(NamedQuality& self, const py::object& predicted, const py::object& truth)
{
  const HeldIds given = idsOf(predicted, "predicted"), expected = idsOf(truth, "truth");
  if (given.view.size() != expected.view.size())
    throw py::value_error("expected as many predicted labels as true ones, found " + std::to_string(given.view.size()) +
                          " and " + std::to_string(expected.view.size()));
  std::vector<std::uint32_t> given_ids, expected_ids;
  readIds(given.view, "predicted", given_ids);
  readIds(expected.view, "truth", expected_ids);
  self.quality.addScan(given_ids.data(), expected_ids.data(), given_ids.size());
}

py::dict figuresOf(const NamedQuality& self)
{
  const PanopticFigures figures = self.quality.figures();
  py::dict dict;
  dict["pq"] = figures.pq, dict["rq"] = figures.rq, dict["sq"] = figures.sq;
  dict["pq_dagger"] = figures.pq_dagger;
  dict["pq_th"] = figures.pq_th, dict["rq_th"] = figures.rq_th, dict["sq_th"] = figures.sq_th;
  dict["pq_st"] = figures.pq_st, dict["rq_st"] = figures.rq_st, dict["sq_st"] = figures.sq_st;
  dict["miou"] = figures.miou;
  dict["pq_th_present"] = figures.pq_th_present;
  return dict;
}

py::dict classesOf(const NamedQuality& self)
{
  py::dict all;
  const ClassTable& table = self.quality.table();
  for (std::size_t i = 0; i < table.size(); ++i)
  {
    const auto index = static_cast<ClassIndex>(i);
    if (!self.quality.isEvaluated(index)) continue;
    const ClassCounts& counts = self.quality.classes()[i];
    py::dict one;
    one["pq"] = counts.pq(), one["sq"] = counts.sq(), one["rq"] = counts.rq(), one["iou"] = counts.iou();
    one["tp"] = counts.tp, one["fp"] = counts.fp, one["fn"] = counts.fn;
    all[py::str(table[index].name)] = one;
  }
  return all;
}

void bindQuality(py::module& module)
{
  py::class_<NamedQuality>(module, "PanopticQuality", kQualityDoc)
      .def(py::init([](const py::object& class_table, int min_points)
                    { return makeQuality(pathOf(class_table), min_points); }),
           py::arg("class_table") = "semantic_kitti", py::arg("min_points") = 50)
      .def("add", &addScan, py::arg("predicted"), py::arg("truth"),
           "Counts one more scan. predicted, truth: (N,) integers as in the data set's files, class in the low 16 "
           "bits,\n"
           "instance in the high ones; see encode_labels(). Ids that the table lacks count as ignored. Raises\n"
           "ValueError where their lengths differ. Linear.")
      .def("figures", &figuresOf,
           "Means over the classes, each in [0, 1]: pq, sq, rq, pq_dagger, the same of things (_th) and stuff (_st), "
           "miou,\n"
           "and pq_th_present over the thing classes that occur.")
      .def("classes", &classesOf, "By class name: pq, sq, rq, iou in [0, 1] and the counts tp, fp, fn.")
      .def_property_readonly(
          "scans", [](const NamedQuality& self) { return self.quality.scanCount(); }, "Number of scans added.")
      .def(
          "__iadd__",
          [](NamedQuality& self, const NamedQuality& other) -> NamedQuality&
          {
            self.quality += other.quality;
            return self;
          },
          py::arg("other"),
          "Adds what another one counted. Raises ValueError where its classes or min_points are others.")
      .def("__eq__", [](const NamedQuality& self, const NamedQuality& other) { return self.quality == other.quality; })
      .def(py::pickle(
          [](const NamedQuality& self)
          { return py::make_tuple(self.class_table, self.quality.minPoints(), toJson(self.quality).dump()); },
          [](const py::tuple& state)
          {
            NamedQuality made = makeQuality(state[0].cast<std::string>(), state[1].cast<int>());
            const auto json = nlohmann::json::parse(state[2].cast<std::string>());
            const auto table = std::make_shared<const ClassTable>(made.quality.table());
            made.quality = panopticQualityFromJson(json, table);
            return made;
          }));
}

std::size_t scanOf(DatasetReader& reader, const std::string& sequence, const py::object& scan)
{
  return withValueErrors(
      [&]() -> std::size_t
      {
        if (py::isinstance<py::str>(scan)) return reader.numberOf(sequence, scan.cast<std::string>());
        const py::object index = py::module::import("operator").attr("index")(scan);
        if (index.cast<py::ssize_t>() < 0)
          throw py::value_error("scan: expected a name or a place from 0, found " + std::string(py::str(index)));
        const auto number = index.cast<std::size_t>();
        reader.requireScan(sequence, number);
        return number;
      });
}

py::array_t<std::uint32_t> arrayOf(const std::vector<std::uint32_t>& ids)
{
  return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(ids.size()), ids.data());
}

/// Reads without the GIL.
template <class Read>
auto readOf(Read&& read)
{
  const py::gil_scoped_release release;
  return withValueErrors(std::forward<Read>(read));
}

py::array_t<float> pointsOfScan(DatasetReader& self, const std::string& sequence, const py::object& scan)
{
  const std::size_t number = scanOf(self, sequence, scan);
  const std::vector<ScanPoint> points = readOf([&] { return self.points(sequence, number); });
  py::array_t<float> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(points.size()), 4});
  if (!points.empty()) std::memcpy(array.mutable_data(), points.data(), points.size() * sizeof(ScanPoint));
  return array;
}

py::array_t<double> posesOf(DatasetReader& self, const std::string& sequence)
{
  const auto poses = readOf([&] { return self.poses(sequence); });
  py::array_t<double> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(poses.size()), 4, 4});
  auto at = array.mutable_unchecked<3>();
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (py::ssize_t row = 0; row < 4; ++row)
      for (py::ssize_t column = 0; column < 4; ++column)
        at(static_cast<py::ssize_t>(i), row, column) = poses[i].matrix()(row, column);
  return array;
}

std::string writeScan(DatasetReader& self, const py::object& output, const std::string& sequence,
                      const py::object& scan, const py::object& labels, const py::object& instances)
{
  const std::size_t number = scanOf(self, sequence, scan);
  const HeldIds classes = idsOf(labels, "labels"), ids = idsOf(instances, "instances");
  const std::string root = pathOf(output);
  return readOf(
      [&]
      {
        std::vector<std::uint32_t> class_of_point, instance_of_point;
        readIds(classes.view, "labels", class_of_point);
        readIds(ids.view, "instances", instance_of_point);
        return self.write(root, sequence, self.scans(sequence)[number], class_of_point, instance_of_point);
      });
}

void bindDataset(py::module& module)
{
  py::class_<DatasetReader>(module, "SemanticKitti", kDatasetDoc)
      .def(py::init(
               [](const py::object& dataset, const py::object& semantics, const py::object& class_table,
                  const py::object& label_table)
               {
                 const std::string folder = pathOf(dataset), classes = pathOf(semantics);
                 return withValueErrors(
                     [&] {
                       return std::make_unique<DatasetReader>(folder, classes, pathOf(class_table),
                                                              pathOf(label_table));
                     });
               }),
           py::arg("dataset"), py::arg("semantics") = "", py::arg("class_table") = "semantic_kitti",
           py::arg("label_table") = "")
      .def_property_readonly(
          "sequences", [](const DatasetReader& self) { return withValueErrors([&] { return self.sequences(); }); },
          "The sequences that hold scans, [\"00\", ..].")
      .def_static(
          "split", [](const std::string& name) { return semanticKittiSplit(name); }, py::arg("name"),
          "The sequences of the official split \"train\", \"valid\" or \"test\".")
      .def(
          "scans",
          [](DatasetReader& self, const std::string& sequence) { return readOf([&] { return self.scans(sequence); }); },
          py::arg("sequence"), "The names of a sequence's scans, in order.")
      .def("points", &pointsOfScan, py::arg("sequence"), py::arg("scan"),
           "(N, 4) float32: x y z [m] and remission, in the file's order.")
      .def(
          "labels",
          [](DatasetReader& self, const std::string& sequence, const py::object& scan)
          {
            const std::size_t number = scanOf(self, sequence, scan);
            return arrayOf(readOf([&] { return self.labels(sequence, number); }));
          },
          py::arg("sequence"), py::arg("scan"),
          "(N,) uint32, the ground truth as in its file: class in the low, instance in the high 16 bits.")
      .def(
          "classes",
          [](DatasetReader& self, const std::string& sequence, const py::object& scan)
          {
            const std::size_t number = scanOf(self, sequence, scan);
            return arrayOf(readOf([&] { return self.classes(sequence, number); }));
          },
          py::arg("sequence"), py::arg("scan"),
          "(N,) uint32, raw class ids of class_table to cluster by: the network's, or those of the ground truth.")
      .def("poses", &posesOf, py::arg("sequence"),
           "(n, 4, 4) float64, the lidar at each scan in its frame at the first; (0, 4, 4) without poses.txt.")
      .def(
          "times",
          [](DatasetReader& self, const std::string& sequence)
          {
            const std::vector<double> times = readOf([&] { return self.times(sequence); });
            return py::array_t<double>(static_cast<py::ssize_t>(times.size()), times.data());
          },
          py::arg("sequence"), "(n,) float64, time of each scan [s]; (0,) without times.txt.")
      .def("write", &writeScan, py::arg("output"), py::arg("sequence"), py::arg("scan"), py::arg("labels"),
           py::arg("instances"),
           "Writes output/sequences/SS/predictions/NNNNNN.label as evaluator and leaderboard read it, aside and then\n"
           "renamed, and returns its path. labels, instances: (N,) integers, what a segmenter returned.");
}

py::array_t<std::uint32_t> encode(const py::object& labels, const py::object& instances, const py::object& class_table)
{
  const HeldIds classes = idsOf(labels, "labels"), ids = idsOf(instances, "instances");
  std::vector<std::uint32_t> class_of_point, instance_of_point, encoded;
  readIds(classes.view, "labels", class_of_point);
  readIds(ids.view, "instances", instance_of_point);
  withValueErrors([&]
                  { encodeLabels(class_of_point, instance_of_point, ClassTable::load(pathOf(class_table)), encoded); });
  return arrayOf(encoded);
}

py::dict classIds(const py::object& class_table)
{
  const ClassTable table = withValueErrors([&] { return ClassTable::load(pathOf(class_table)); });
  py::dict ids;
  for (std::size_t i = 0; i < table.size(); ++i)
    if (const ClassInfo& info = table[static_cast<ClassIndex>(i)]; !info.ids.empty())
      ids[py::str(info.name)] = info.ids;
  return ids;
}
}  // namespace

void bindData(py::module& module)
{
  bindQuality(module);
  bindDataset(module);
  module.def("encode_labels", &encode, py::arg("labels"), py::arg("instances"),
             py::arg("class_table") = "semantic_kitti",
             "(N,) uint32 as in a label file: instance in the high 16 bits, the class's canonical id (10, not 252) in\n"
             "the low ones, 0 for ids that the table lacks. Raises ValueError on an instance above 65535.");
  module.def("class_ids", &classIds, py::arg("class_table") = "semantic_kitti",
             "The raw ids of each class of a table, by name, the canonical one first.");
}
}  // namespace lidar_panoptic_clustering
