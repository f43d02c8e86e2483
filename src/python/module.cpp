#include "lidar_panoptic_clustering/core/version.h"
#include "python/bindings.h"

PYBIND11_MODULE(_core, module)
{
  using namespace lidar_panoptic_clustering;
  module.doc() = "The C++ of lidar_panoptic_clustering; its names are those of the package.";
  module.attr("__version__") = version();
  bindSegmenter(module);
  bindStreams(module);
  bindData(module);
  bindBenchmark(module);
}
