// Prints the objects of a KITTI scan (float32 x y z intensity a point), without a network:
//   scan_objects 000000.bin
#include <lidar_panoptic_clustering/scan_to_objects/scan_to_objects.h>

#include <cstdio>
#include <exception>
#include <fstream>

namespace lpc = lidar_panoptic_clustering;

int main(int argc, char** argv)
{
  if (argc != 2)
  {
    std::fprintf(stderr, "usage: scan_objects SCAN.bin\n");
    return 2;
  }
  try
  {
    std::ifstream file(argv[1], std::ios::binary);
    std::vector<lpc::ScanPoint> points;
    for (lpc::ScanPoint p; file.read(reinterpret_cast<char*>(&p), sizeof(p));) points.push_back(p);
    if (points.empty()) throw std::runtime_error(std::string("no points in ") + argv[1]);

    lpc::ScanToObjectsConfig config;
    config.labeller.labels = "none";  // ground, structure and objects from the geometry
    config.algorithm = "birds_eye";
    lpc::ScanToObjects chain(config);
    chain.process(lpc::viewOf(points));

    std::printf("%zu points, %zu objects\n", points.size(), chain.instances().count());
    for (std::size_t i = 0; i < chain.instances().count(); ++i)
    {
      const auto& object = chain.instances().objects[i];
      const auto& box = chain.boxes()[i];
      if (object.point_count < 50) continue;
      std::printf("%s %zu: %u points at (%.1f, %.1f) m, %.1f x %.1f x %.1f m\n",
                  chain.classTable()[object.class_index].name.c_str(), i + 1, object.point_count, box.x, box.y,
                  box.length, box.width, box.height);
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "scan_objects: %s\n", error.what());
    return 1;
  }
}
