// Any bytes as a sensor_msgs/PointCloud2, with a header that may contradict them: organised, or refused with what was
// expected. Nothing outside of the data is read: it lies in a block of its own.
#include "fuzz_input.h"
#include "lidar_panoptic_clustering/projection/organizer.h"

#include <memory>

using namespace lidar_panoptic_clustering;

namespace
{
RawCloud readHeader(FuzzInput& input)
{
  static const char* const kNames[] = {"x", "y", "z", "intensity", "ring", "label", "class_id", "t"};
  RawCloud raw;
  raw.height = input.take<std::uint16_t>(), raw.width = input.take<std::uint16_t>();
  raw.point_step = input.take<std::uint16_t>();
  raw.row_step = raw.width * raw.point_step + input.take<std::uint8_t>();
  raw.is_bigendian = input.take<std::uint8_t>() == 1;
  for (std::size_t n = input.take<std::uint8_t>() % 10; n > 0; --n)
  {
    const auto name = kNames[input.take<std::uint8_t>() % 8];
    const std::uint32_t offset = input.take<std::uint16_t>();
    const auto type = static_cast<std::uint8_t>(input.take<std::uint8_t>() % 10);
    raw.fields.push_back({name, offset, type, 1U + (input.take<std::uint8_t>() == 7 ? 1U : 0U)});
  }
  return raw;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  FuzzInput input(bytes, size);
  OrganizerConfig config;
  const auto choice = input.take<std::uint8_t>();
  config.layout = layoutNames()[choice % layoutNames().size()];
  if ((choice & 16U) != 0) config.sensor = "vlp16";
  config.labels = (choice & 32U) != 0;
  RawCloud raw = readHeader(input);
  const std::string rest = input.takeText(size);
  const std::unique_ptr<std::uint8_t[]> data(new std::uint8_t[rest.size()]);
  std::copy(rest.begin(), rest.end(), data.get());
  raw.data = data.get(), raw.data_size = rest.size();
  mayRefuse(
      [&]
      {
        Organizer organizer(config);
        OrganizedScan out;
        for (int scan = 0; scan < 2; ++scan)  // the second by what the first has taught
        {
          organizer.organize(raw, out);
          mustHold(out.image.cloud.size() == std::size_t{out.image.cloud.width} * out.image.cloud.height,
                   "width x height points");
        }
      });
  return 0;
}
