// A bag of a sequence, played into the graph, gives what the player of the sequence gives there.
#include "bags/sequence_bag.h"
#include "graph_fixture.h"
#include "labelled_scene.h"
#include "recorded_data.h"
#include "ros/cloud_subscription.h"
#include "tiny_dataset.h"

#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"
#include "lidar_panoptic_clustering/projection/organizer.h"
#include "lidar_panoptic_clustering/simulation/lidar_simulator.h"

#include <pcl_ros/point_cloud.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstring>
#include <map>

namespace lidar_panoptic_clustering
{
namespace
{
std::string bag_path;  // rosbag plays it in a loop, /points as /played/points and so on, once it is there

constexpr int kScans = 2;

/// Two simulated scans as KITTI has them: the returns ring after ring, each counter-clockwise from straight ahead.
class SimulatedDataset
{
public:
  SimulatedDataset() : root_(fs::temp_directory_path() / ("lidar_panoptic_simulated_" + std::to_string(getpid())))
  {
    LidarSimulator simulator(SensorModel::load("hdl64e"));
    PanopticCloud cloud;
    for (int scan = 0; scan < kScans; ++scan)
    {
      simulator.scan(40 * static_cast<std::uint64_t>(scan), cloud);
      write(scan, cloud);
    }
  }
  ~SimulatedDataset() { fs::remove_all(root_); }

  std::string root() const { return root_.string(); }

private:
  void write(int scan, const PanopticCloud& cloud) const
  {
    std::vector<float> points;
    std::vector<std::uint32_t> labels;
    for (std::uint32_t row = 0; row < cloud.height; ++row)
      for (std::uint32_t step = 0; step < cloud.width; ++step)
      {
        const PanopticPoint& p = cloud.at((cloud.width / 2 - 1 - step + cloud.width) % cloud.width, row);
        if (!std::isfinite(p.x)) continue;
        points.insert(points.end(), {p.x, p.y, p.z, p.intensity});
        labels.push_back(p.instance << 16U | p.label);
      }
    const fs::path sequence = root_ / "sequences" / "00";
    writeFile(sequence / "velodyne" / ("00000" + std::to_string(scan) + ".bin"), points);
    writeFile(sequence / "labels" / ("00000" + std::to_string(scan) + ".label"), labels);
  }

  const fs::path root_;
};

/// The next clouds of a topic, until there is one of each scan; by how many returns it has.
template <class Cloud>
std::map<std::size_t, boost::shared_ptr<const Cloud>> oneOfEachScan(const std::string& topic)
{
  Probe<Cloud> probe(topic);
  std::map<std::size_t, boost::shared_ptr<const Cloud>> clouds;
  while (clouds.size() < kScans)
  {
    const auto cloud = probe.next();
    if (!cloud) break;
    const auto is_return = [](const auto& p) { return std::isfinite(p.x); };
    clouds[static_cast<std::size_t>(std::count_if(cloud->points.begin(), cloud->points.end(), is_return))] = cloud;
  }
  EXPECT_EQ(clouds.size(), static_cast<std::size_t>(kScans)) << topic;
  return clouds;
}

void expectSame(const PanopticCloud& played, const PanopticCloud& expected)
{
  ASSERT_EQ(played.width, expected.width);
  ASSERT_EQ(played.height, expected.height);
  std::size_t different = 0, things = 0;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const PanopticPoint &p = played.points[i], &e = expected.points[i];
    const bool same_place = std::memcmp(p.data, e.data, 3 * sizeof(float)) == 0 || (std::isnan(p.x) && std::isnan(e.x));
    different += same_place && p.label == e.label && p.instance == e.instance && p.intensity == e.intensity ? 0 : 1;
    things += e.instance > 0 ? 1 : 0;
  }
  EXPECT_EQ(different, 0U);
  EXPECT_GT(things, 1000U);
}

class SequenceBagGraph : public Graph
{
protected:
  void loadPlayer(const std::string& dataset)
  {
    ros::param::set(player_ + "/dataset", dataset);
    ros::param::set(player_ + "/rate_hz", 4.0);
    ros::param::set(player_ + "/wait_for_subscribers", 0);
    ASSERT_TRUE(tryLoad(player_, "SemanticKittiPlayerNodelet"));
  }
  void loadOrganizer()
  {
    ros::param::set(organizer_ + "/columns", 2048);
    ASSERT_TRUE(tryLoad(organizer_, "OrganizerNodelet", {{organizer_ + "/input", "/played/points"}}));
  }

  const std::string player_ = newName(), organizer_ = newName();
};

TEST_F(SequenceBagGraph, GivesTheLabelsAndInstancesThatThePlayerGives)
{
  const SimulatedDataset dataset;
  SequenceBagConfig config;
  config.dataset = dataset.root();
  config.output = bag_path;
  writeSequenceBag(config, [](std::uint64_t, std::uint64_t) { return true; });
  loadPlayer(dataset.root());
  loadOrganizer();

  const auto truth = oneOfEachScan<PanopticCloud>("/played/ground_truth");
  for (const auto& [returns, cloud] : oneOfEachScan<PanopticCloud>(player_ + "/ground_truth"))
  {
    ASSERT_EQ(truth.count(returns), 1U);
    expectSame(*truth.at(returns), *cloud);
  }
  for (const auto& [algorithm, type] : clusterNodelets())
  {
    SCOPED_TRACE(algorithm);
    const std::string of_player = newName(), of_bag = newName();
    ASSERT_TRUE(tryLoad(of_player, type, {{of_player + "/input", player_ + "/output"}}));
    ASSERT_TRUE(tryLoad(of_bag, type, {{of_bag + "/input", organizer_ + "/output"}}));
    const auto played = oneOfEachScan<PanopticCloud>(of_bag + "/output");
    for (const auto& [returns, cloud] : oneOfEachScan<PanopticCloud>(of_player + "/output"))
    {
      ASSERT_EQ(played.count(returns), 1U);
      expectSame(*played.at(returns), *cloud);
      EXPECT_EQ(played.at(returns)->header.frame_id, "velodyne");
    }
  }
}

// In recorded scans points share pixels, and rings begin and end anywhere: organised by the bag's field ring, each
// point must come to lie where the player puts it.
TEST(RecordedSequenceBag, IsOrganisedAsThePlayerDoes)
{
  REQUIRE_RECORDED_DATA(data);
  SequenceBagConfig config;
  config.dataset = data + "/semantickitti";
  config.output = (fs::temp_directory_path() / ("lidar_panoptic_recorded_" + std::to_string(getpid()))).string();
  config.count = 3;
  OrganizerConfig organizer_config;
  organizer_config.columns = config.projection.columns;
  Organizer organizer(organizer_config);
  OrganizedScan organized;
  PointProjector projector(config.projection);
  Projection expected;
  for (const std::string sequence : {"00", "05", "07"})
  {
    config.sequence = sequence;
    writeSequenceBag(config, [](std::uint64_t, std::uint64_t) { return true; });
    const SemanticKittiSequence scans(config.dataset, sequence);
    std::vector<ScanPoint> points;
    std::vector<std::uint32_t> labels;
    std::size_t scan = 0;
    rosbag::Bag bag(config.output);
    rosbag::View messages(bag, rosbag::TopicQuery("/points"));
    for (const auto& message : messages)
    {
      organizer.organize(viewOf(*message.instantiate<sensor_msgs::PointCloud2>()), organized);
      scans.readScan(scan, points);
      scans.readLabels(scan++, points.size(), labels);
      projector.project(points, labels, expected);
      EXPECT_EQ(organized.layout, Layout::kRing);
      ASSERT_EQ(organized.image.pixel_of_point, expected.pixel_of_point) << sequence;
      EXPECT_EQ(organized.image.owner_of_pixel, expected.owner_of_pixel) << sequence;
      for (std::size_t i = 0; i < labels.size(); ++i) ASSERT_EQ(organized.labels[i], rawClass(labels[i])) << sequence;
    }
    EXPECT_EQ(scan, 3U);
  }
  fs::remove(config.output);
}
}  // namespace
}  // namespace lidar_panoptic_clustering

int main(int argc, char** argv)
{
  if (argc > 1) lidar_panoptic_clustering::bag_path = argv[1];
  const int result = lidar_panoptic_clustering::runGraphTests(argc, argv, "sequence_bag_test");
  if (argc > 1) std::filesystem::remove(argv[1]);
  return result;
}
