#include "python/array_segmenter.h"
#include "python/bindings.h"
#include "python/numpy_arrays.h"

#include <pybind11/stl.h>

namespace py = pybind11;

namespace lidar_panoptic_clustering
{
namespace
{
constexpr const char* kSegmenterDoc = R"(Finds the objects in labelled lidar scans: classes in, instances out.

    segmenter = Segmenter("birds_eye", class_table="semantic_kitti", min_points=1)
    instances = segmenter(points, labels)

algorithm: "birds_eye" (distance in bird's-eye view, as ALPINE, Sautier 2025), "euclidean" (Rusu 2010), "depth"
(Bogoslavskyi and Stachniss 2016), "scan_line_run" (Zermas 2017) or "supervoxel" (Papon 2013).

Every parameter of the algorithm's nodelet is a keyword of the same name: parameters(algorithm) lists them with default,
range and unit in the name (_m, _deg, _px). The most used:

class_table: what the labels mean, a table that ships with the package (class_tables()) or a YAML file.
label_table: where the labels that come are of another table, e.g. "semantic_kitti_training".
max_unknown_labels: share of labels that the table may lack, 0 to 1.
min_points: smaller instances get id 0.
vote: whether all points of an instance get the class of most of them.
layout: how the points lie. "auto": (N, 3 or more) ring after ring as in KITTI's files, or by `ring`; (H, W, 3 or more)
    with rows as scan lines. "merged": no scan lines, in any order (not for "depth" and "scan_line_run"). "organized",
    "ring", "beams", "unfold": as OrganizerNodelet takes a message, with its checks; then orientation, sensor count.
rows, columns: of the range image; 64 and 2048 unless given.

Raises ValueError, with what there is, on an unknown algorithm, parameter or table, and on a value out of range.
May be used from several threads, where its calls wait for one another; a segmenter a thread runs side by side.)";

constexpr const char* kCallDoc = R"(The instance of each point.

points: (N, 3 or more) or (H, W, 3 or more) floating-point numbers: x y z [m] in the sensor's frame, x ahead, y left, z
    up; then remission. NaN, infinity and (0, 0, 0) are no returns. NumPy arrays, Torch tensors on the CPU, views of any
    stride; never changed, copied only inside.
labels: (N,) or (H, W) integers, the class of each point; an instance in the high 16 bits, as in SemanticKITTI's files,
    is left out.
ring: (N,) integers, the ring of each point, for points in another order than KITTI's.
return_labels: also return the classes after the vote.

Returns instances, uint32 of the shape of labels: 0 for what is no thing, 1..n for things, hidden points included; with
return_labels a pair (instances, labels), the latter uint32 raw ids of class_table.
Raises ValueError, with what was expected and found, where points or labels cannot be used.
Linear in the points, but for what the algorithm takes. The GIL is released.)";

constexpr const char* kObjectsDoc =
    R"(The objects of the last call, a structured array, objects[i] being instance i + 1:
id (uint32), class (uint32, canonical raw id of class_table, after the vote), box (x y z of its centre, length, width,
height [m], yaw [rad] about z in (-pi/2, pi/2], sensor frame: the smallest upright box around its points) and points
(uint32, how many it has). Computed when asked for.)";

struct PackedObject
{
  std::uint32_t id, class_id;
  InstanceBox box;
  std::uint32_t points;
};
static_assert(sizeof(PackedObject) == 40 && sizeof(InstanceBox) == 28, "as the dtype has it");

/// Made anew for each array: names of its own ("class" is no name of C++).
py::dtype objectType()
{
  py::list box, fields;
  for (const char* name : {"x", "y", "z", "length", "width", "height", "yaw"}) box.append(py::make_tuple(name, "<f4"));
  fields.append(py::make_tuple("id", "<u4"));
  fields.append(py::make_tuple("class", "<u4"));
  fields.append(py::make_tuple("box", box));
  fields.append(py::make_tuple("points", "<u4"));
  return py::dtype::from_args(fields);
}

py::array objectArray(ArraySegmenter& segmenter)
{
  std::vector<ArrayObject> objects;
  {
    const py::gil_scoped_release release;
    objects = segmenter.objects();
  }
  py::array array(objectType(), std::vector<py::ssize_t>{static_cast<py::ssize_t>(objects.size())});
  auto* to = static_cast<PackedObject*>(array.mutable_data());
  for (const ArrayObject& object : objects) *to++ = {object.id, object.class_id, object.box, object.points};
  return array;
}

py::object segment(ArraySegmenter& segmenter, const py::object& given_points, const py::object& given_labels,
                   const py::object& given_ring, bool return_labels)
{
  const HeldPoints points = pointsOf(given_points);
  const HeldIds labels = idsOf(given_labels, "labels", points);
  HeldIds ring;
  const bool has_ring = !given_ring.is_none();
  if (has_ring) ring = idsOf(given_ring, "ring", points);
  py::array_t<std::uint32_t> instances = newIds(labels), voted;
  if (return_labels) voted = newIds(labels);
  std::uint32_t *instances_to = instances.mutable_data(), *voted_to = return_labels ? voted.mutable_data() : nullptr;
  {
    const py::gil_scoped_release release;
    withValueErrors(
        [&] { segmenter.segment(points.view, labels.view, has_ring ? &ring.view : nullptr, instances_to, voted_to); });
  }
  if (return_labels) return py::make_tuple(instances, voted);
  return py::object(std::move(instances));
}

py::dict dictOf(const ParameterMap& parameters)
{
  py::dict dict;
  for (const auto& [name, value] : parameters) dict[py::str(name)] = objectOf(value);
  return dict;
}

std::unique_ptr<ArraySegmenter> makeSegmenter(const std::string& algorithm, const py::dict& keywords)
{
  const ParameterMap parameters = parametersOf(keywords);
  return withValueErrors([&] { return std::make_unique<ArraySegmenter>(algorithm, parameters); });
}

/// name -> {"default": .., "min": .., "max": .., "choices": ..}
py::dict describe(const std::vector<ParameterInfo>& list)
{
  py::dict all;
  for (const ParameterInfo& info : list)
  {
    py::dict one;
    one["default"] = objectOf(info.value);
    if (std::holds_alternative<int>(info.value))
      one["min"] = static_cast<int>(info.min), one["max"] = static_cast<int>(info.max);
    if (std::holds_alternative<double>(info.value)) one["min"] = info.min, one["max"] = info.max;
    if (!info.choices.empty()) one["choices"] = info.choices;
    all[py::str(info.name)] = one;
  }
  return all;
}
}  // namespace

void bindSegmenter(py::module& module)
{
  py::class_<ArraySegmenter>(module, "Segmenter", kSegmenterDoc)
      .def(py::init([](const std::string& algorithm, const py::kwargs& keywords)
                    { return makeSegmenter(algorithm, keywords); }),
           py::arg("algorithm") = "birds_eye")
      .def("__call__", &segment, py::arg("points"), py::arg("labels"), py::arg("ring") = py::none(),
           py::arg("return_labels") = false, kCallDoc)
      .def_property_readonly("objects", &objectArray, kObjectsDoc)
      .def_property_readonly("algorithm", &ArraySegmenter::algorithm, "The algorithm's name.")
      .def_property_readonly(
          "parameters",
          [](const ArraySegmenter& segmenter)
          {
            py::dict values;
            for (const ParameterInfo& info : segmenterParameters(segmenter.algorithm()))
              values[py::str(info.name)] = objectOf(info.value);
            for (const auto& [name, value] : segmenter.parameters()) values[py::str(name)] = objectOf(value);
            return values;
          },
          "All parameters by name, with the values in use.")
      .def("__repr__",
           [](const ArraySegmenter& segmenter)
           {
             std::string text = "Segmenter(" + std::string(py::repr(py::str(segmenter.algorithm())));
             for (const auto& [name, value] : segmenter.parameters())
               text += ", " + name + "=" + std::string(py::repr(objectOf(value)));
             return text + ")";
           })
      .def(py::pickle([](const ArraySegmenter& segmenter)
                      { return py::make_tuple(segmenter.algorithm(), dictOf(segmenter.parameters())); },
                      [](const py::tuple& state)
                      { return makeSegmenter(state[0].cast<std::string>(), state[1].cast<py::dict>()); }));

  module.def("algorithms", &algorithmNames, "The algorithms' names.");
  module.def(
      "parameters", [](const std::string& algorithm) { return describe(segmenterParameters(algorithm)); },
      py::arg("algorithm") = "birds_eye",
      "The parameters of Segmenter(algorithm): name -> {default, min, max} for numbers, {default, choices} for "
      "text.\n\n"
      "Raises ValueError on an unknown algorithm.");
  module.def(
      "survey_parameters",
      [](const std::string& algorithm)
      {
        algorithmParameters(algorithm);  // refuses an unknown name
        return dictOf(surveyParameters(algorithm));
      },
      py::arg("algorithm"),
      "What makes Segmenter(algorithm) the one of Zhao et al. 2021: no class sizes, no refinement.\n\n"
      "Raises ValueError on an unknown algorithm.");
  module.def("class_tables", &ClassTable::shippedNames, "The names of the class tables that ship with the package.");
}
}  // namespace lidar_panoptic_clustering
