// Any bytes as the files of a SemanticKITTI sequence: read whole, or refused by name.
#include "fuzz_input.h"
#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <filesystem>
#include <fstream>

using namespace lidar_panoptic_clustering;
namespace fs = std::filesystem;

namespace
{
/// A folder of this process, removed at its end.
struct Folder
{
  Folder()
  {
    std::string pattern = (fs::temp_directory_path() / "dataset_fuzz_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::logic_error("no temporary folder");
    root = pattern;
    for (const char* name : {"velodyne", "labels"}) fs::create_directories(root / "sequences/00" / name);
  }
  ~Folder() { fs::remove_all(root); }

  void write(const std::string& name, const std::string& text) const
  {
    std::ofstream(root / "sequences/00" / name, std::ios::binary) << text;
  }

  fs::path root;
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  static const Folder folder;
  FuzzInput input(bytes, size);
  const std::size_t scan_bytes = input.take<std::uint16_t>(), label_bytes = input.take<std::uint16_t>();
  const std::size_t pose_bytes = input.take<std::uint16_t>(), time_bytes = input.take<std::uint16_t>();
  const std::string scan = input.takeText(scan_bytes);
  folder.write("velodyne/000000.bin", scan);
  folder.write("labels/000000.label", input.takeText(label_bytes));
  folder.write("poses.txt", input.takeText(pose_bytes));
  folder.write("times.txt", input.takeText(time_bytes));
  folder.write("calib.txt", input.takeText(size));

  const SemanticKittiSequence sequence(folder.root.string(), "00");
  std::vector<ScanPoint> points;
  std::vector<std::uint32_t> labels;
  const bool refused = mayRefuse([&] { sequence.readScan(0, points); });
  if (!refused)
  {
    mustHold(points.size() * sizeof(ScanPoint) == scan.size(), "all points");
    mayRefuse([&]
              { sequence.readLabels(0, points.size(), labels), mustHold(labels.size() == points.size(), "labels"); });
    PointProjector projector(ProjectionConfig{16, 64});
    Projection projection;
    projector.project(points, {}, projection);
  }
  mayRefuse([&] { mustHold(sequence.readPoses().size() <= 1, "a pose a scan"); });
  mayRefuse([&] { mustHold(sequence.readTimes().size() <= 1, "a time a scan"); });
  return 0;
}
