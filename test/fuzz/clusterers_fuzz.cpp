// Any points through the pipeline of every algorithm: ids on all things and on nothing else, 1 to n.
#include "fuzz_input.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "lidar_panoptic_clustering/pipeline/frame_pipeline.h"

#include <cmath>

using namespace lidar_panoptic_clustering;

namespace
{
/// A header of four bytes: algorithm, rows, parameters, how coordinates are read. Then 13 bytes a point: three floats
/// and a class.
struct Case
{
  std::string algorithm;
  ParameterMap parameters;
  LabelledCloud cloud;
};

Case readCase(FuzzInput& input)
{
  constexpr std::uint32_t kLabels[] = {10, 252, 30, 18, 40, 777};
  constexpr double kSeeds[] = {8.0, 1.0, 2.0, 0.1}, kDistances[] = {0.0, 0.001, 0.5, 10.0};
  Case result;
  const auto names = algorithmNames();
  result.algorithm = names[input.take<std::uint8_t>() % names.size()];
  const std::uint32_t rows = 1U + input.take<std::uint8_t>() % 16U;
  const auto choice = input.take<std::uint8_t>();
  const bool near = input.take<std::uint8_t>() % 2 != 0;  // within 50 m, so that changed bits leave them close
  if (result.algorithm == "supervoxel") result.parameters["seed_m"] = kSeeds[choice % 4];
  if (result.algorithm == "birds_eye" || result.algorithm == "euclidean")
    result.parameters["distance_m"] = kDistances[choice % 4];
  result.parameters["max_range_m"] = (choice & 4U) != 0 ? 10000.0 : 300.0;
  result.parameters["link_distance_scale"] = (choice & 8U) != 0 ? 0.05 : (choice & 16U) != 0 ? 100.0 : 1.0;
  result.parameters["class_policy"] = std::string((choice & 32U) != 0   ? "any"
                                                  : (choice & 64U) != 0 ? "group"
                                                                        : "class");

  std::vector<LabelledPoint> points;
  while (input.left() >= 13 && points.size() < 1024)
  {
    LabelledPoint p;
    for (float* axis : {&p.x, &p.y, &p.z})
    {
      *axis = input.take<float>();
      if (near) *axis = std::fmod(*axis, 50.0F);
    }
    p.label = kLabels[input.take<std::uint8_t>() % 6];
    points.push_back(p);
  }
  const std::uint32_t columns = (static_cast<std::uint32_t>(points.size()) + rows - 1) / rows;
  result.cloud = LabelledCloud(columns, rows);
  std::copy(points.begin(), points.end(), result.cloud.points.begin());
  return result;
}

void expectSound(const FramePipeline& pipeline, const LabelledCloud& in, const PanopticCloud& out)
{
  mustHold(out.size() == in.size() && out.width == in.width && out.height == in.height, "out is as large as in");
  const auto count = pipeline.instances().count();
  std::vector<std::uint32_t> points(count + 1, 0);
  for (const PanopticPoint& p : out.points) mustHold(p.instance <= count, "ids are 1 to n"), ++points[p.instance];
  mustHold(out.size() - points[0] == pipeline.things().size(), "every thing has an id");
  for (std::size_t i = 1; i <= count; ++i)
    mustHold(points[i] > 0 && points[i] == pipeline.instances().objects[i - 1].point_count, "no id without points");
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  static const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  FuzzInput input(bytes, size);
  const Case scan = readCase(input);
  Algorithm made = makeAlgorithm(scan.algorithm, scan.parameters);
  FramePipeline pipeline(table, made.pipeline, std::move(made.clusterer));
  PanopticCloud out;
  mayRefuse(
      [&]
      {
        pipeline.segment(scan.cloud);
        pipeline.paint(scan.cloud, out);
        expectSound(pipeline, scan.cloud, out);
      });
  return 0;
}
