// Every algorithm on the recorded scans: SemanticKITTI with true classes, PandaSet and Ouster with every return a car.
#include "recorded_data.h"
#include "scan_fixture.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/evaluation/panoptic_quality.h"
#include "lidar_panoptic_clustering/projection/hidden_points.h"
#include "lidar_panoptic_clustering/projection/point_projection.h"

#include <gtest/gtest.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cstring>

namespace lidar_panoptic_clustering
{
namespace
{
struct Expectation
{
  std::string algorithm;
  std::uint64_t cars;  ///< found by the released code of Zhao et al. 2021 on these scans
};

class RecordedScans : public testing::TestWithParam<Expectation>
{
};

TEST_P(RecordedScans, asManyCarsAreFoundAsByTheSurveysCode)
{
  REQUIRE_RECORDED_DATA(data);
  Algorithm made = makeAlgorithm(GetParam().algorithm);
  FramePipeline pipeline(kittiTable(), made.pipeline, std::move(made.clusterer));
  PointProjector projector{ProjectionConfig{}};
  HiddenPointLabeller hidden(kittiTable());
  PanopticQuality quality(kittiTable());

  std::vector<ScanPoint> scan;
  std::vector<std::uint32_t> truth, pixel_instances, instances, classes;
  Projection projection;
  for (const std::string name : {"00", "05", "07"})
  {
    const SemanticKittiSequence sequence(data + "/semantickitti", name);
    ASSERT_EQ(sequence.size(), 10U);
    for (std::size_t i = 0; i < sequence.size(); ++i)
    {
      sequence.readScan(i, scan);
      sequence.readLabels(i, scan.size(), truth);
      projector.project(scan, truth, projection);
      pipeline.segment(projection.cloud);
      pixelInstances(pipeline.things(), pipeline.instances(), pixel_instances);
      hidden.label(scan, truth, projection, pixel_instances, instances);
      classes.clear();
      for (std::size_t k = 0; k < truth.size(); ++k)
      {
        classes.push_back(rawClass(truth[k]));
        ASSERT_EQ((*kittiTable())[kittiTable()->find(classes[k])].isThing(), instances[k] != 0) << name << " " << i;
      }
      quality.addScan(ScanLabels::separate(classes.data(), instances.data()), ScanLabels::packed(truth.data()),
                      truth.size());
    }
  }
  const auto cars = quality.classes()[kittiTable()->findByName("car")].tp;
  std::cout << GetParam().algorithm << ": " << cars << " cars found, the survey's code " << GetParam().cars << '\n';
  EXPECT_GE(cars, GetParam().cars);
}

INSTANTIATE_TEST_SUITE_P(Algorithms, RecordedScans,
                         testing::Values(Expectation{"euclidean", 257}, Expectation{"supervoxel", 220},
                                         Expectation{"depth", 214}, Expectation{"scan_line_run", 263}),
                         [](const auto& test) { return test.param.algorithm; });

/// Coordinates of a PCD file as they lie in it, float32 or float64, every return a car.
LabelledCloud readAllCars(const std::string& path)
{
  pcl::PCLPointCloud2 file;
  if (pcl::io::loadPCDFile(path, file) != 0) throw std::runtime_error(path + ": cannot be read");
  LabelledCloud cloud(file.width, file.height);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
  {
    float* to = cloud.points[i].data;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto& field = file.fields[axis];
      const std::uint8_t* from = &file.data[i * file.point_step + field.offset];
      double wide = 0.0;
      if (field.datatype == pcl::PCLPointField::FLOAT64)
        std::memcpy(&wide, from, sizeof(wide)), to[axis] = static_cast<float>(wide);
      else
        std::memcpy(&to[axis], from, sizeof(float));
    }
    cloud.points[i].label = kCar;
  }
  return cloud;
}

class OtherSensors : public testing::TestWithParam<std::string>
{
};

TEST_P(OtherSensors, everyReturnAThing)
{
  REQUIRE_RECORDED_DATA(data);
  for (const std::string file : {"pandaset/0001.pcd", "pandaset/0002.pcd", "pandaset/0003.pcd",
                                 "ouster/os1_128_1024_0.pcd", "ouster/os1_128_1024_1.pcd"})
  {
    const LabelledCloud cloud = readAllCars(data + "/" + file);
    const PanopticCloud out = runAlgorithm(GetParam(), cloud);
    ASSERT_EQ(out.points.size(), cloud.points.size());
    std::uint32_t returns = 0, things = 0, largest = 0;
    for (const auto& p : out.points)
    {
      const double range = std::hypot(p.x, p.y, p.z);
      returns += range > 0.0 && range <= 300.0 ? 1 : 0;  // false for NaN
      things += p.instance > 0 ? 1 : 0;
      largest = std::max(largest, p.instance);
    }
    EXPECT_EQ(things, returns) << file;
    EXPECT_GT(returns, 40000U) << file;
    EXPECT_GT(largest, 10U) << file;
    EXPECT_LT(largest, returns) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(Algorithms, OtherSensors, testing::ValuesIn(algorithmNames()),
                         [](const auto& test) { return test.param; });
}  // namespace
}  // namespace lidar_panoptic_clustering
