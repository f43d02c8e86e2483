#pragma once

#include "lidar_panoptic_clustering/core/parameters.h"
#include "python/array_views.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_panoptic_clustering
{
/// An array and the view of it; the array keeps the numbers alive.
struct HeldPoints
{
  pybind11::array array;
  PointsView view;
};
struct HeldIds
{
  pybind11::array array;
  IdsView view;
};

/// A NumPy array, a Torch tensor on the CPU or whatever else NumPy takes, as points: floating-point numbers of shape
/// (N, 3 or more) or (H, W, 3 or more). Not copied where it is float32 or float64. Throws ValueError with what was
/// expected and found.
HeldPoints pointsOf(const pybind11::object& given);

/// The same as ids of `what`: whole numbers, one a point of `points`.
HeldIds idsOf(const pybind11::object& given, const std::string& what, const HeldPoints& points);
/// The same of any shape of one dimension.
HeldIds idsOf(const pybind11::object& given, const std::string& what);

/// An array of the view's shape, not yet filled.
pybind11::array_t<std::uint32_t> newIds(const HeldIds& like);

/// Keyword arguments as parameters. Throws ValueError where one is no bool, number or text.
ParameterMap parametersOf(const pybind11::dict& keywords);
/// The way back.
pybind11::object objectOf(const ParameterValue& value);

/// Calls `work`; what the library throws as std::runtime_error becomes std::invalid_argument, in Python ValueError.
template <class Work>
auto withValueErrors(Work&& work)
{
  try
  {
    return std::forward<Work>(work)();
  }
  catch (const pybind11::builtin_exception&)
  {
    throw;
  }
  catch (const pybind11::error_already_set&)
  {
    throw;
  }
  catch (const std::runtime_error& error)
  {
    throw std::invalid_argument(error.what());
  }
}
}  // namespace lidar_panoptic_clustering
