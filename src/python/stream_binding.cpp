#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"
#include "python/array_streams.h"
#include "python/bindings.h"
#include "python/numpy_arrays.h"

#include <pybind11/stl.h>

#include <cmath>

namespace py = pybind11;

namespace lidar_panoptic_clustering
{
namespace
{
constexpr const char* kTrackerDoc =
    R"(Gives objects ids that last from scan to scan: a Kalman filter a track, an exact assignment, parts joined.

    tracker = Tracker(class_table="semantic_kitti", max_missed_s=1.5)
    tracks = tracker(points, labels, instances, time_s=0.1 * i, pose=poses[i])

class_table, label_table, max_unknown_labels: as of Segmenter.
max_missed_s: an object that is not seen for longer is a new one when it comes again [s].
vote_over_time: an object has the class it had most often.

Scans come in their order. Raises ValueError, with what there is, on an unknown parameter and a value out of range.
After AB3DMOT (Weng 2020) and training-free 4D panoptic segmentation (Oh et al. 2025, arXiv 2512.18991).)";

constexpr const char* kTrackDoc = R"(The track of each point.

points: (N, 3 or more) or (H, W, 3 or more), x y z [m] in the sensor's frame.
labels: (N,) or (H, W) integers, the classes after the segmenter's vote (return_labels=True).
instances: the like, what the segmenter returned.
time_s: of the scan [s]. One that is not later than the one before teaches nothing.
pose: (4, 4), from the sensor's frame to one that stands still; without, objects are followed in the sensor's frame.
return_labels: also return the classes voted over time.

Returns tracks, uint32 of the shape of labels: 0 where instances is 0, else from 1, never given twice; with
return_labels a pair (tracks, labels). Raises ValueError with what was expected and found. Linear. The GIL is released.)";

constexpr const char* kTrackObjectsDoc =
    R"(The objects of the last call, a structured array: id (uint32, the track), class (uint32, canonical raw id),
instance (uint32, in the scan), velocity (2 float32, over ground along the axes of the fixed frame [m/s]), age_s (float32,
since it was first seen) and points (uint32).)";

constexpr const char* kGroundDoc = R"(Labels a scan without any network: ground, structure and objects.

    labeler = GroundLabeler()
    labels = labeler(points)
    instances = Segmenter("birds_eye", class_table="object")(points, labels)

Keywords: ground_height_m, max_slope, link_m, max_height_m, max_length_m, structure ("strict", "balanced",
"keep_objects"), max_range_m, field_of_view as of OrganizerNodelet with labels "none"; layout, orientation, sensor, rows,
columns as of Segmenter. Raises ValueError, with what there is, on others and on values out of range.)";

constexpr const char* kGroundCallDoc = R"(The class of each point: raw ids of the class table "object".

points, ring: as of Segmenter; z points up. Returns uint32 of shape (N,) or (H, W): 0 for no return, 1 ground, 2
structure, 3 object, as class_ids("object") has them. Raises ValueError where the points do not lie as the layout says.
Linear in points and pixels. The GIL is released.)";

constexpr const char* kSimulatorDoc =
    R"(A lidar on a car that drives along an endless street, with exact labels: scans without a data set.

    simulator = LidarSimulator("hdl64e", seed=3)
    points, labels, instances = simulator.scan(0)

sensor: one that ships with the package (sensors()) or a YAML file. Keywords: seed, rate_hz, speed_mps, noise_scale,
dropout_scale, traffic_density, parking_density, pedestrian_density. Raises ValueError on values out of range.)";

std::vector<py::ssize_t> shapeOf(const py::array& array)
{
  return {array.shape(), array.shape() + array.ndim()};
}

Eigen::Isometry3d poseOf(const py::object& given)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (given.is_none()) return pose;
  const auto matrix = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!matrix || matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
  {
    PyErr_Clear();
    throw py::value_error("pose: expected a matrix of shape (4, 4), found " + std::string(py::repr(given)));
  }
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
    {
      if (!std::isfinite(matrix.at(row, column))) throw py::value_error("pose: expected finite numbers, found another");
      if (row < 3) pose(row, column) = matrix.at(row, column);
    }
  return pose;
}

py::object track(ArrayTracker& tracker, const py::object& given_points, const py::object& given_labels,
                 const py::object& given_instances, double time_s, const py::object& given_pose, bool return_labels)
{
  const HeldPoints points = pointsOf(given_points);
  const HeldIds labels = idsOf(given_labels, "labels", points), instances = idsOf(given_instances, "instances", points);
  const Eigen::Isometry3d pose = poseOf(given_pose);
  py::array_t<std::uint32_t> tracks(shapeOf(labels.array)), voted;
  if (return_labels) voted = py::array_t<std::uint32_t>(shapeOf(labels.array));
  std::uint32_t *tracks_to = tracks.mutable_data(), *voted_to = return_labels ? voted.mutable_data() : nullptr;
  {
    const py::gil_scoped_release release;
    withValueErrors([&]
                    { tracker.track(points.view, labels.view, instances.view, time_s, pose, tracks_to, voted_to); });
  }
  if (return_labels) return py::make_tuple(tracks, voted);
  return py::object(std::move(tracks));
}

py::array trackArray(ArrayTracker& tracker)
{
  const std::vector<ArrayTrack> objects = tracker.objects();
  py::list fields;
  for (const char* name : {"id", "class", "instance"}) fields.append(py::make_tuple(name, "<u4"));
  fields.append(py::make_tuple("velocity", "<f4", 2));
  fields.append(py::make_tuple("age_s", "<f4"));
  fields.append(py::make_tuple("points", "<u4"));
  static_assert(sizeof(ArrayTrack) == 28, "as the dtype has it");
  return py::array(py::dtype::from_args(fields), std::vector<py::ssize_t>{static_cast<py::ssize_t>(objects.size())},
                   objects.data());
}

py::array_t<std::uint32_t> labelGround(ArrayGroundLabeler& labeler, const py::object& given_points,
                                       const py::object& given_ring)
{
  const HeldPoints points = pointsOf(given_points);
  HeldIds ring;
  const bool has_ring = !given_ring.is_none();
  if (has_ring) ring = idsOf(given_ring, "ring", points);
  std::vector<py::ssize_t> shape = shapeOf(points.array);
  shape.pop_back();
  py::array_t<std::uint32_t> labels(shape);
  std::uint32_t* to = labels.mutable_data();
  const py::gil_scoped_release release;
  withValueErrors([&] { labeler.label(points.view, has_ring ? &ring.view : nullptr, to); });
  return labels;
}

py::dict groundOf(ArrayGroundLabeler& labeler)
{
  const GroundReport report = labeler.ground();
  py::dict ground;
  ground["found"] = report.found;
  ground["sensor_height_m"] = report.sensor_height_m;
  ground["slope_deg"] = report.slope_deg;
  ground["plane"] = py::make_tuple(report.plane.slope_x, report.plane.slope_y, report.plane.offset);
  return ground;
}

/// A simulator and the cloud it fills; one thread at a time, as the GIL is held.
struct Simulator
{
  LidarSimulator simulator;
  PanopticCloud cloud;
};

py::tuple scan(Simulator& self, std::uint64_t frame)
{
  withValueErrors([&] { self.simulator.scan(frame, self.cloud); });
  const auto height = static_cast<py::ssize_t>(self.cloud.height), width = static_cast<py::ssize_t>(self.cloud.width);
  py::array_t<float> points(std::vector<py::ssize_t>{height, width, 4});
  py::array_t<std::uint32_t> labels(std::vector<py::ssize_t>{height, width}), instances({height, width});
  float* to = points.mutable_data();
  std::uint32_t *label = labels.mutable_data(), *instance = instances.mutable_data();
  for (const PanopticPoint& point : self.cloud.points)
  {
    *to++ = point.x, *to++ = point.y, *to++ = point.z, *to++ = point.intensity;
    *label++ = point.label, *instance++ = point.instance;
  }
  return py::make_tuple(points, labels, instances);
}

py::array_t<double> poseMatrix(const simulation::Pose& pose)
{
  py::array_t<double> matrix(std::vector<py::ssize_t>{4, 4});
  auto at = matrix.mutable_unchecked<2>();
  for (py::ssize_t row = 0; row < 4; ++row)
    for (py::ssize_t column = 0; column < 4; ++column) at(row, column) = row == column ? 1.0 : 0.0;
  at(0, 0) = at(1, 1) = std::cos(pose.yaw);
  at(1, 0) = std::sin(pose.yaw), at(0, 1) = -at(1, 0);
  at(0, 3) = pose.x, at(1, 3) = pose.y, at(2, 3) = pose.z;
  return matrix;
}

void bindTracker(py::module& module)
{
  py::class_<ArrayTracker>(module, "Tracker", kTrackerDoc)
      .def(py::init(
          [](const py::kwargs& keywords)
          {
            const ParameterMap parameters = parametersOf(keywords);
            return withValueErrors([&] { return std::make_unique<ArrayTracker>(parameters); });
          }))
      .def("__call__", &track, py::arg("points"), py::arg("labels"), py::arg("instances"), py::arg("time_s"),
           py::arg("pose") = py::none(), py::arg("return_labels") = false, kTrackDoc)
      .def_property_readonly("objects", &trackArray, kTrackObjectsDoc)
      .def("restart", &ArrayTracker::restart, "Forgets all tracks and numbers from 1 again: for another sequence.");
}

void bindGroundLabeler(py::module& module)
{
  py::class_<ArrayGroundLabeler>(module, "GroundLabeler", kGroundDoc)
      .def(py::init(
          [](const py::kwargs& keywords)
          {
            const ParameterMap parameters = parametersOf(keywords);
            return withValueErrors([&] { return std::make_unique<ArrayGroundLabeler>(parameters); });
          }))
      .def("__call__", &labelGround, py::arg("points"), py::arg("ring") = py::none(), kGroundCallDoc)
      .def_property_readonly("ground", &groundOf,
                             "What the last scan tells of the ground: found (bool), sensor_height_m over it, slope_deg "
                             "against the sensor's x-y plane, plane (a, b, c): z = a x + b y + c [m].");
}

void bindSimulator(py::module& module)
{
  py::class_<Simulator>(module, "LidarSimulator", kSimulatorDoc)
      .def(py::init(
               [](const std::string& sensor, const py::kwargs& keywords)
               {
                 const ParameterMap parameters = parametersOf(keywords);
                 return withValueErrors(
                     [&]
                     {
                       SimulatorConfig config;
                       applyParameters(config, parameters);
                       return std::make_unique<Simulator>(
                           Simulator{LidarSimulator(SensorModel::load(sensor), config), PanopticCloud()});
                     });
               }),
           py::arg("sensor") = "hdl64e")
      .def("scan", &scan, py::arg("frame"),
           "The scan of a moment, frame / rate_hz: points (H, W, 4) float32, x y z [m] and intensity, NaN for no "
           "return;\n"
           "labels (H, W) uint32, raw ids of \"semantic_kitti\"; instances (H, W) uint32, 0 for stuff.")
      .def(
          "pose",
          [](const Simulator& self, std::uint64_t frame)
          { return poseMatrix(withValueErrors([&] { return self.simulator.pose(frame); })); },
          py::arg("frame"), "The sensor in the world at a moment, (4, 4) float64.");
  module.def("sensors", &SensorModel::shippedNames, "The names of the sensors that ship with the package.");
}
}  // namespace

void bindStreams(py::module& module)
{
  bindTracker(module);
  bindGroundLabeler(module);
  bindSimulator(module);
}
}  // namespace lidar_panoptic_clustering
