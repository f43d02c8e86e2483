#pragma once

#include <pybind11/pybind11.h>

namespace lidar_panoptic_clustering
{
/// Each adds its classes to the module `_core`.
void bindSegmenter(pybind11::module& module);
void bindStreams(pybind11::module& module);
void bindData(pybind11::module& module);
void bindBenchmark(pybind11::module& module);
}  // namespace lidar_panoptic_clustering
