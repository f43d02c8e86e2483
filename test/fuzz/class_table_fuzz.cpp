// Any text as a class table: refused, or a table that the rest of the library can work with.
#include "fuzz_input.h"
#include "lidar_panoptic_clustering/core/class_mapping.h"
#include "lidar_panoptic_clustering/core/class_table.h"

using namespace lidar_panoptic_clustering;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  mayRefuse(
      [&]
      {
        const ClassTable table = ClassTable::parse(text, "input.yaml");
        mustHold(table.size() > 1 && table.size() <= 256, "1 to 255 classes");
        for (std::size_t i = 1; i < table.size(); ++i)
        {
          const ClassInfo& info = table[static_cast<ClassIndex>(i)];
          mustHold(!info.ids.empty() && table.find(info.ids[0]) == i, "ids lead to their class");
          mustHold(info.group < table.groupCount(), "a group that there is");
          mustHold(!info.isThing() || (info.link_distance_m >= 0.05F && info.link_distance_m <= 100.0F),
                   "link's range");
          mustHold(!info.isThing() || (info.width_m > 0.0F && info.length_m <= 1000.0F), "size's range");
        }
        static const ClassTable kitti = ClassTable::load("semantic_kitti");
        ClassMapping(table, kitti);
        ClassMapping(kitti, table);
      });
  return 0;
}
