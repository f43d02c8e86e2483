// Any text as a sensor file: refused, or a model whose numbers have their ranges.
#include "fuzz_input.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include <cmath>

using namespace lidar_panoptic_clustering;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  mayRefuse(
      [&]
      {
        const SensorModel model = SensorModel::parse(text, "input.yaml");
        mustHold(model.rows() > 0 && model.rows() <= 4096, "rows");
        mustHold(model.columns > 0 && model.columns <= 65536, "columns");
        mustHold(model.max_range_m > model.min_range_m && model.max_range_m <= 10000.0F, "ranges");
        mustHold(std::isfinite(model.azimuth(0)) && std::isfinite(model.azimuth(model.columns - 1)), "azimuths");
      });
  return 0;
}
