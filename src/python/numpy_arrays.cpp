#include "python/numpy_arrays.h"

#include <limits>

namespace py = pybind11;

namespace lidar_panoptic_clustering
{
namespace
{
/// "(5, 2)"
std::string shapeText(const py::array& array)
{
  return py::str(array.attr("shape"));
}

std::string typeName(const py::handle& object)
{
  return py::str(object.attr("__class__").attr("__name__"));
}

/// The array that NumPy makes of what was given, the same numbers where it can.
py::array arrayOf(const py::object& given, const std::string& what)
{
  if (py::isinstance<py::array>(given)) return py::reinterpret_borrow<py::array>(given);
  const py::module numpy = py::module::import("numpy");
  const bool only_dlpack = py::hasattr(given, "__dlpack__") && !py::hasattr(given, "__array__");
  try
  {
    if (only_dlpack && py::hasattr(numpy, "from_dlpack")) return numpy.attr("from_dlpack")(given).cast<py::array>();
    return numpy.attr("asarray")(given).cast<py::array>();
  }
  catch (py::error_already_set& error)
  {
    if (!error.matches(PyExc_Exception)) throw;
    throw py::value_error(what + ": expected an array, found " + typeName(given) + ": " +
                          std::string(py::str(error.value())));
  }
}

char kindOf(const py::array& array)
{
  return array.dtype().attr("kind").cast<std::string>().front();
}

bool isNative(const py::array& array)
{
  return array.dtype().attr("isnative").cast<bool>();
}

py::array cast(const py::array& array, const char* type)
{
  return array.attr("astype")(type).cast<py::array>();
}

/// Infinity for what is too large.
double numberOf(const py::object& value)
{
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  return std::numeric_limits<double>::infinity();
}

HeldIds integersOf(const py::object& given, const std::string& what)
{
  HeldIds held{arrayOf(given, what), {}};
  const char kind = kindOf(held.array);
  if (kind != 'i' && kind != 'u')
    throw py::value_error(what + ": expected whole numbers, found " + std::string(py::str(held.array.dtype())));
  if (!isNative(held.array)) held.array = cast(held.array, kind == 'i' ? "int64" : "uint64");
  held.view.data = static_cast<const std::uint8_t*>(held.array.data());
  held.view.bytes = static_cast<std::size_t>(held.array.itemsize());
  held.view.is_signed = kind == 'i';
  return held;
}
}  // namespace

HeldPoints pointsOf(const py::object& given)
{
  HeldPoints held{arrayOf(given, "points"), {}};
  py::array& array = held.array;
  if (kindOf(array) != 'f')
    throw py::value_error("points: expected floating-point numbers, found " + std::string(py::str(array.dtype())));
  const auto dimensions = array.ndim();
  if ((dimensions != 2 && dimensions != 3) || array.shape(dimensions - 1) < 3)
    throw py::value_error("points: expected shape (N, 3 or more) or (H, W, 3 or more), found " + shapeText(array));
  const auto bytes = array.itemsize();
  if ((bytes != sizeof(float) && bytes != sizeof(double)) || !isNative(array))
    array = cast(array, bytes < static_cast<py::ssize_t>(sizeof(double)) ? "float32" : "float64");

  PointsView& view = held.view;
  view.data = static_cast<const std::uint8_t*>(array.data());
  view.is_double = array.itemsize() == sizeof(double);
  view.organized = dimensions == 3;
  view.height = view.organized ? static_cast<std::size_t>(array.shape(0)) : 1;
  view.width = static_cast<std::size_t>(array.shape(dimensions - 2));
  view.channels = static_cast<std::size_t>(array.shape(dimensions - 1));
  view.row_step = view.organized ? array.strides(0) : 0;
  view.column_step = array.strides(dimensions - 2);
  view.channel_step = array.strides(dimensions - 1);
  if (view.size() > 0x7FFFFFFFU)
    throw py::value_error("points: expected 2147483647 at most, found " + std::to_string(view.size()));
  return held;
}

HeldIds idsOf(const py::object& given, const std::string& what, const HeldPoints& points)
{
  HeldIds held = integersOf(given, what);
  const py::array& array = held.array;
  const PointsView& like = points.view;
  const bool organized = like.organized;
  const bool fits = organized ? array.ndim() == 2 && static_cast<std::size_t>(array.shape(0)) == like.height &&
                                    static_cast<std::size_t>(array.shape(1)) == like.width
                              : array.ndim() == 1 && static_cast<std::size_t>(array.shape(0)) == like.width;
  if (!fits)
  {
    const std::string expected = organized ? "(" + std::to_string(like.height) + ", " + std::to_string(like.width) + ")"
                                           : "(" + std::to_string(like.width) + ",)";
    throw py::value_error(what + ": expected shape " + expected + ", one a point, found " + shapeText(array));
  }
  held.view.height = like.height, held.view.width = like.width;
  held.view.row_step = organized ? array.strides(0) : 0;
  held.view.column_step = array.strides(organized ? 1 : 0);
  return held;
}

HeldIds idsOf(const py::object& given, const std::string& what)
{
  HeldIds held = integersOf(given, what);
  if (held.array.ndim() != 1) throw py::value_error(what + ": expected shape (N,), found " + shapeText(held.array));
  held.view.width = static_cast<std::size_t>(held.array.shape(0));
  held.view.column_step = held.array.strides(0);
  return held;
}

py::array_t<std::uint32_t> newIds(const HeldIds& like)
{
  std::vector<py::ssize_t> shape(like.array.shape(), like.array.shape() + like.array.ndim());
  return py::array_t<std::uint32_t>(shape);
}

ParameterMap parametersOf(const py::dict& keywords)
{
  ParameterMap parameters;
  for (const auto& [key, given] : keywords)
  {
    const std::string name = py::str(key);
    const bool is_numpy = py::hasattr(given, "dtype") && py::hasattr(given, "item");  // numpy.bool_ is no bool
    const py::object value = is_numpy ? py::object(given.attr("item")()) : py::reinterpret_borrow<py::object>(given);
    if (py::isinstance<py::bool_>(value))
      parameters[name] = value.cast<bool>();
    else if (py::isinstance<py::str>(value))
      parameters[name] = value.cast<std::string>();
    else if (PyIndex_Check(value.ptr()) != 0 || py::hasattr(value, "__float__"))
      parameters[name] = numberOf(value);
    else if (py::hasattr(value, "__fspath__"))
      parameters[name] = value.attr("__fspath__")().cast<std::string>();
    else
      throw py::value_error("parameter '" + name + "': expected a bool, a number or text, found " + typeName(value));
  }
  return parameters;
}

py::object objectOf(const ParameterValue& value)
{
  return std::visit([](const auto& held) -> py::object { return py::cast(held); }, value);
}
}  // namespace lidar_panoptic_clustering
