#include "bags/sequence_bag.h"

#include "tiny_dataset.h"

#include <gtest/gtest.h>
#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tf2_msgs/TFMessage.h>

#include <csignal>
#include <cstdlib>
#include <iterator>

namespace lidar_panoptic_clustering
{
namespace
{
using CloudMessage = sensor_msgs::PointCloud2;

bool goOn(std::uint64_t, std::uint64_t)
{
  return true;
}

class SequenceBag : public testing::Test, protected TinyDataset
{
protected:
  SequenceBag() : TinyDataset("bag")
  {
    config_.dataset = root_.string();
    config_.sequence = "07";
    config_.output = (root_ / "07.bag").string();
    config_.projection.columns = 32;
  }

  template <class Message>
  std::vector<boost::shared_ptr<Message>> messages(const std::string& topic) const
  {
    rosbag::Bag bag(config_.output);
    std::vector<boost::shared_ptr<Message>> list;
    for (const auto& message : rosbag::View(bag, rosbag::TopicQuery(topic)))
    {
      list.push_back(message.template instantiate<Message>());
      EXPECT_TRUE(list.back()) << topic << " holds another type, " << message.getDataType();
      EXPECT_EQ(message.getTime(), stampOf(*list.back())) << topic;
    }
    return list;
  }
  static ros::Time stampOf(const CloudMessage& message) { return message.header.stamp; }
  static ros::Time stampOf(const tf2_msgs::TFMessage& message) { return message.transforms.at(0).header.stamp; }

  std::string errorOf(const SequenceBagProgress& progress = goOn) const
  {
    try
    {
      writeSequenceBag(config_, progress);
    }
    catch (const std::exception& error)
    {
      return error.what();
    }
    return "nothing was thrown";
  }

  void expectNothingWritten() const
  {
    EXPECT_FALSE(fs::exists(config_.output));
    for (const auto& entry : fs::recursive_directory_iterator(root_)) EXPECT_NE(entry.path().extension(), ".part");
  }

  SequenceBagConfig config_;
};

PointSet returnsIn(const CloudMessage& message)
{
  PointSet set;
  sensor_msgs::PointCloud2ConstIterator<float> at(message, "x");
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> label(message, "label");
  for (; at != at.end(); ++at, ++label) set.emplace(at[0], at[1], at[2], *label);
  return set;
}

TEST_F(SequenceBag, SequencesStayBelowTheirFolder)
{
  for (const std::string name : {"../sequences/07", "..", "", "/tmp"})
  {
    config_.sequence = name;
    EXPECT_NE(errorOf().find("expected the name of one folder"), std::string::npos) << name;
  }
  expectNothingWritten();
}

TEST_F(SequenceBag, HoldsEveryPointWithItsRingAndClass)
{
  const SequenceBagSummary summary = writeSequenceBag(config_, goOn);
  EXPECT_EQ(summary.scans, 3U);
  EXPECT_EQ(summary.points, 3U * kScanPoints);
  EXPECT_EQ(summary.bytes, fs::file_size(config_.output));
  const auto clouds = messages<CloudMessage>("/points");
  ASSERT_EQ(clouds.size(), 3U);
  for (int scan = 0; scan < 3; ++scan)
  {
    const CloudMessage& cloud = *clouds[scan];
    EXPECT_EQ(cloud.header.frame_id, "velodyne");
    EXPECT_EQ(cloud.height, 1U);
    EXPECT_EQ(cloud.width, kScanPoints);
    EXPECT_EQ(cloud.point_step * cloud.width, cloud.data.size());
    EXPECT_EQ(returnsIn(cloud), expectedReturns(scan, kMovingCar)) << scan;
    // in the file's order: three rings of eight, of a sensor of 64
    const auto values = scanPoints(scan);
    sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), intensity(cloud, "intensity");
    sensor_msgs::PointCloud2ConstIterator<std::uint16_t> ring(cloud, "ring");
    for (std::size_t i = 0; i < kScanPoints; ++i, ++x, ++intensity, ++ring)
    {
      EXPECT_EQ(*x, values[4 * i]);
      EXPECT_EQ(*intensity, 0.25F);
      EXPECT_EQ(*ring, 63 - i / 8);
    }
  }
}

TEST_F(SequenceBag, StampsAreTheSequencesTimes)
{
  config_.start_s = 1000.5;
  writeSequenceBag(config_, goOn);
  for (const std::string topic : {"/points", "/ground_truth"})
  {
    const auto clouds = messages<CloudMessage>(topic);
    ASSERT_EQ(clouds.size(), 3U) << topic;
    EXPECT_EQ(clouds[0]->header.stamp, ros::Time(1000, 500000000)) << topic;
    EXPECT_EQ(clouds[1]->header.stamp, ros::Time(1000, 750000000)) << topic;
    EXPECT_EQ(clouds[2]->header.stamp, ros::Time(1001, 0)) << topic;
  }
  fs::remove(sequence() / "times.txt");
  writeSequenceBag(config_, goOn);
  EXPECT_EQ(messages<CloudMessage>("/points").at(2)->header.stamp, ros::Time(1000, 700000000));
}

TEST_F(SequenceBag, TransformsAreTheSensorsPoses)
{
  config_.frame_id = "roof";
  EXPECT_TRUE(writeSequenceBag(config_, goOn).poses);
  const auto transforms = messages<tf2_msgs::TFMessage>("/tf");
  ASSERT_EQ(transforms.size(), 3U);
  for (int scan = 0; scan < 3; ++scan)
  {
    ASSERT_EQ(transforms[scan]->transforms.size(), 1U);
    const auto& transform = transforms[scan]->transforms[0];
    EXPECT_EQ(transform.header.frame_id, "world");
    EXPECT_EQ(transform.child_frame_id, "roof");
    EXPECT_NEAR(transform.transform.translation.x, 2.0 * scan, 1e-9);
    EXPECT_NEAR(transform.transform.translation.y, 0.0, 1e-9);
    EXPECT_NEAR(transform.transform.rotation.w, 1.0, 1e-9);
  }
  fs::remove(sequence() / "poses.txt");
  EXPECT_FALSE(writeSequenceBag(config_, goOn).poses);
  EXPECT_TRUE(messages<tf2_msgs::TFMessage>("/tf").empty());
}

TEST_F(SequenceBag, GroundTruthHasInstancesWhateverTheSemantics)
{
  config_.semantics = root_.string();
  writeSequenceBag(config_, goOn);
  EXPECT_EQ(returnsIn(*messages<CloudMessage>("/points").at(1)), expectedReturns(1, kPerson));
  const auto truths = messages<CloudMessage>("/ground_truth");
  ASSERT_EQ(truths.size(), 3U);
  PanopticCloud cloud;
  pcl::fromROSMsg(*truths[1], cloud);
  EXPECT_EQ(cloud.height, 64U);
  EXPECT_EQ(cloud.width, 32U);
  EXPECT_EQ(returnsIn(cloud), expectedReturns(1, kMovingCar));
  for (const auto& p : cloud.points) EXPECT_EQ(p.instance, p.label == kMovingCar ? 5U : 0U);
}

TEST_F(SequenceBag, TheLabelTableSaysWhatPredictedIdsMean)
{
  std::vector<std::uint32_t> training(kScanPoints, 9);
  std::fill(training.begin(), training.begin() + 8, 6);
  for (int scan = 0; scan < 3; ++scan) writeFile(file("predictions", scan, ".label"), training);
  config_.semantics = root_.string();
  EXPECT_NE(errorOf().find("'semantic_kitti_training'"), std::string::npos) << errorOf();
  expectNothingWritten();
  config_.label_table = "semantic_kitti_training";
  writeSequenceBag(config_, goOn);
  EXPECT_EQ(returnsIn(*messages<CloudMessage>("/points").at(1)), expectedReturns(1, kPerson));
  fs::remove(config_.output);
  config_.semantics.clear();
  EXPECT_EQ(errorOf(), "label table: expected predictions whose ids it says, found none");
  expectNothingWritten();
}

TEST_F(SequenceBag, WithoutLabelsThereIsNoLabelFieldAndNoTruth)
{
  fs::remove_all(sequence() / "labels");
  EXPECT_FALSE(writeSequenceBag(config_, goOn).labelled);
  const auto cloud = messages<CloudMessage>("/points").at(0);
  EXPECT_EQ(cloud->fields.size(), 5U);
  for (const auto& field : cloud->fields) EXPECT_NE(field.name, "label");
  EXPECT_TRUE(messages<CloudMessage>("/ground_truth").empty());
}

TEST_F(SequenceBag, PartsAndCompression)
{
  config_.first = 1;
  config_.count = 1;
  for (const std::string compression : {"none", "lz4", "bz2"})
  {
    config_.compression = compression;
    EXPECT_EQ(writeSequenceBag(config_, goOn).scans, 1U);
    const auto clouds = messages<CloudMessage>("/points");
    ASSERT_EQ(clouds.size(), 1U) << compression;
    EXPECT_EQ(returnsIn(*clouds[0]), expectedReturns(1, kMovingCar)) << compression;
  }
  config_.count = 100;
  EXPECT_EQ(writeSequenceBag(config_, goOn).scans, 2U);
}

TEST_F(SequenceBag, ErrorsSayWhatWasExpected)
{
  const SequenceBagConfig right = config_;
  config_.first = 3;
  EXPECT_EQ(errorOf(), "first: expected one of the scans 0 to 2 of sequence 07, found 3");
  config_ = right;
  config_.compression = "zip";
  EXPECT_EQ(errorOf(), "compression: expected none, lz4 or bz2, found 'zip'");
  config_ = right;
  config_.frame_id = "/velodyne";
  EXPECT_EQ(errorOf(), "frame id: expected a name without a leading slash, found '/velodyne'");
  config_ = right;
  config_.start_s = 0.0;
  EXPECT_EQ(errorOf(), "start: expected 1 to 4e9 seconds, found 0");
  config_ = right;
  config_.output = (root_ / "nowhere" / "07.bag").string();
  EXPECT_EQ(errorOf().find("cannot write " + config_.output + ": "), 0U);
  config_.output = root_.string();
  EXPECT_EQ(errorOf(), "cannot write " + root_.string() + ": expected a regular file or none");
}

TEST_F(SequenceBag, IsThereWholeOrNotAtAll)
{
  EXPECT_EQ(errorOf([](std::uint64_t done, std::uint64_t) { return done < 2; }), "interrupted");
  expectNothingWritten();
  writeFile(file("labels", 2, ".label"), scanLabels(), 80);
  EXPECT_NE(errorOf().find("000002.label"), std::string::npos);
  expectNothingWritten();
  std::ofstream(config_.output) << "an older file";
  EXPECT_NE(errorOf().find("000002.label"), std::string::npos);
  std::ifstream older(config_.output);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(older), {}), "an older file");
}

TEST_F(SequenceBag, SaysSoWhereTheDiskIsFull)
{
  struct sigaction before;
  sigaction(SIGXFSZ, nullptr, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit full{6000, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  const std::string error = errorOf();
  setrlimit(RLIMIT_FSIZE, &limit);
  sigaction(SIGXFSZ, &before, nullptr);
  EXPECT_EQ(error.find("cannot write " + config_.output + ": "), 0U) << error;
  expectNothingWritten();
}

/// Exit status of the program, which is built into the folder of this test; what it prints goes to a file.
int runProgram(const std::string& arguments, const fs::path& printed)
{
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "semantickitti_to_bag";
  const int status = std::system((program.string() + " " + arguments + " > " + printed.string() + " 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(SequenceBag, ProgramWritesItAndRefusesWrongOptions)
{
  const fs::path printed = root_ / "printed.txt";
  const auto text = [&printed]
  {
    std::ifstream in(printed);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(runProgram("--help", printed), 0);
  EXPECT_NE(text().find("--compression"), std::string::npos);
  const std::string dataset = "--dataset " + root_.string() + " --sequence 07";
  EXPECT_EQ(runProgram(dataset, printed), 1);
  EXPECT_EQ(text(), "semantickitti_to_bag: --output is missing; see --help\n");
  EXPECT_EQ(runProgram(dataset + " --output " + config_.output + " --count 0", printed), 1);
  EXPECT_EQ(text(), "semantickitti_to_bag: --count: expected 1 or more, found 0\n");
  expectNothingWritten();
  EXPECT_EQ(runProgram(dataset + " --output " + config_.output, printed), 0);
  EXPECT_NE(text().find("07.bag: 3 scans, 72 points, "), std::string::npos) << text();
  EXPECT_EQ(messages<CloudMessage>("/points").size(), 3U);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
