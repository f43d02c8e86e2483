// SemanticKITTI's scans as a driver would send them: organizer, nodelet and the way back give what the benchmark gives.
#include "organizer_fixture.h"
#include "recorded_data.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"
#include "tools/support/scan_clusterer.h"

namespace lidar_panoptic_clustering
{
namespace
{
/// The points in the order of the file, with the classes of a network.
sensor_msgs::PointCloud2Ptr messageOf(const BenchmarkScan& scan, ros::Time stamp)
{
  std::uint32_t step = 0;
  constexpr auto kF32 = NumberType::kFloat32;
  auto fields =
      packed({{"x", kF32}, {"y", kF32}, {"z", kF32}, {"intensity", kF32}, {"label", NumberType::kUint16}}, step);
  RawMessage raw(1, static_cast<std::uint32_t>(scan.points.size()), std::move(fields), step);
  for (std::size_t i = 0; i < scan.points.size(); ++i)
  {
    raw.setPoint(0, i, scan.points[i].x, scan.points[i].y, scan.points[i].z);
    raw.set(0, i, "intensity", scan.points[i].remission);
    raw.set(0, i, "label", rawClass(scan.classes[i]));
  }
  return toRosMessage(raw, "velodyne", stamp);
}

struct Case
{
  std::string algorithm, nodelet, semantics;
};

class KittiThroughTheGraph : public Graph, public testing::WithParamInterface<Case>
{
protected:
  void start()
  {
    ros::param::set(name_ + "/layout", "unfold");
    ros::param::set(name_ + "/sensor", "hdl64e");
    ros::param::set(name_ + "/columns", 2048);  // the benchmark's
    input_ = advertise<sensor_msgs::PointCloud2>(name_ + "/input");
    const std::string clusterer = newName();
    ASSERT_TRUE(tryLoad(clusterer, GetParam().nodelet, {{clusterer + "/input", name_ + "/output"}}));
    ASSERT_TRUE(tryLoad(name_, "OrganizerNodelet", {{name_ + "/panoptic", clusterer + "/output"}}));
    original_ = std::make_unique<Probe<sensor_msgs::PointCloud2>>(name_ + "/output_original");
    waitForSubscriber(input_);
    waitForListener(clusterer + "/output");
    waitForListener(name_ + "/output");
  }

  const std::string name_ = newName();
  ros::Publisher input_;
  std::unique_ptr<Probe<sensor_msgs::PointCloud2>> original_;
};

TEST_P(KittiThroughTheGraph, GivesEachPointWhatTheBenchmarkGivesIt)
{
  REQUIRE_RECORDED_DATA(data);
  start();
  const auto table = kittiTable();
  BenchmarkSettings settings;
  settings.dataset = data + "/semantickitti";
  settings.sequences = {"00", "05", "07"};
  if (!GetParam().semantics.empty()) settings.semantics = settings.dataset + "/predictions/" + GetParam().semantics;
  settings.rows = {{GetParam().algorithm, GetParam().algorithm, {}, false}};
  const BenchmarkScans scans(settings, table);
  ASSERT_EQ(scans.size(), 30U);
  ScanClusterer clusterer(settings, table);
  PanopticQuality through_graph(table), of_benchmark(table);

  BenchmarkScan scan;
  PanopticCloud image;
  std::vector<std::uint32_t> expected, found, instance;
  for (std::size_t k = 0; k < scans.size(); ++k)
  {
    SCOPED_TRACE(scans.name(k));
    scans.read(k, scan);
    FrameTime time;
    clusterer.project(scan);
    clusterer.cluster(0, image, expected, time);

    input_.publish(messageOf(scan, ros::Time(100.0 + static_cast<double>(k))));
    const auto back = original_->next();
    ASSERT_TRUE(back);
    // the message's own label is of two bytes, and stays
    encodeLabels(idsIn(*back, "panoptic_label"), idsIn(*back, "instance"), *table, found);
    ASSERT_EQ(found, expected);
    through_graph.addScan(ScanLabels::packed(found.data()), ScanLabels::packed(scan.truth.data()), found.size());
    of_benchmark.addScan(ScanLabels::packed(expected.data()), ScanLabels::packed(scan.truth.data()), expected.size());
  }
  std::cout << GetParam().algorithm << ": PQ of things that occur " << through_graph.figures().pq_th_present << '\n';
  EXPECT_EQ(through_graph.figures().pq_th_present, of_benchmark.figures().pq_th_present);
  EXPECT_GT(through_graph.figures().pq_th_present, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, KittiThroughTheGraph,
                         testing::Values(Case{"birds_eye", "BirdsEyeClusterNodelet", ""},
                                         Case{"birds_eye", "BirdsEyeClusterNodelet", "mininet"},
                                         Case{"scan_line_run", "ScanLineRunClusterNodelet", "mininet"}),
                         [](const auto& test)
                         { return test.param.algorithm + (test.param.semantics.empty() ? "" : "_mininet"); });
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  return lidar_panoptic_clustering::runGraphTests(argc, argv, "organizer_kitti_test");
}
