#include "lidar_panoptic_clustering/datasets/semantic_kitti.h"

#include "recorded_data.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace lidar_panoptic_clustering
{
namespace
{
namespace fs = std::filesystem;
using Labels = std::vector<std::uint32_t>;

void writeBytes(const fs::path& path, const std::string& bytes)
{
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

template <class Record>
void writeRecords(const fs::path& path, const std::vector<Record>& records)
{
  std::string bytes(records.size() * sizeof(Record), '\0');
  std::memcpy(bytes.data(), records.data(), bytes.size());
  writeBytes(path, bytes);
}

/// What the call throws as std::runtime_error.
template <class Call>
std::string errorOf(Call&& call)
{
  try
  {
    call();
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return "no error";
}

void expectMentions(const std::string& message, const std::vector<std::string>& words)
{
  for (const auto& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << "'" << message << "' has no " << word;
}

/// A data set of its own in a temporary folder: sequence 04 with scans 000000 (2 points) and 000002 (1 point).
class SemanticKittiFolder : public testing::Test
{
protected:
  void SetUp() override
  {
    char name[] = "/tmp/semantic_kitti_test_XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    root_ = name;
    sequence_ = root_ / "sequences/04";
    writeRecords<float>(sequence_ / "velodyne/000002.bin", {9, 8, 7, 0.5F});
    writeRecords<float>(sequence_ / "velodyne/000000.bin", {1, 2, 3, 0.25F, 4, 5, 6, 0.75F});
    writeRecords<std::uint32_t>(sequence_ / "labels/000000.label", {0x0003000A, 40});
    writeRecords<std::uint32_t>(sequence_ / "labels/000002.label", {70});
  }
  void TearDown() override { fs::remove_all(root_); }

  SemanticKittiSequence open(const std::string& predictions = "") const { return {root_.string(), "04", predictions}; }

  fs::path root_, sequence_;
  std::vector<ScanPoint> points_;
  Labels labels_;
};
}  // namespace

TEST_F(SemanticKittiFolder, ReadsScansAndLabelsInTheOrderOfTheirNames)
{
  EXPECT_EQ(semanticKittiSequences(root_.string()), std::vector<std::string>{"04"});
  const auto sequence = open();
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.scanName(0), "000000");
  EXPECT_EQ(sequence.scanName(1), "000002");
  EXPECT_TRUE(sequence.hasLabels());

  sequence.readScan(0, points_);
  ASSERT_EQ(points_.size(), 2U);
  EXPECT_EQ(points_[1].x, 4.0F);
  EXPECT_EQ(points_[1].y, 5.0F);
  EXPECT_EQ(points_[1].z, 6.0F);
  EXPECT_EQ(points_[1].remission, 0.75F);
  sequence.readLabels(0, 2, labels_);
  EXPECT_EQ(labels_, Labels({0x0003000A, 40}));
  EXPECT_EQ(rawClass(labels_[0]), 10U);
  EXPECT_EQ(rawInstance(labels_[0]), 3U);
  sequence.readScan(1, points_);
  ASSERT_EQ(points_.size(), 1U);
  EXPECT_EQ(points_[0].x, 9.0F);
}

TEST_F(SemanticKittiFolder, ReadsPredictionsFromAFolderOfTheirOwn)
{
  const auto other = root_ / "mine";
  writeLabelFile(predictionFile(other.string(), "04", "000000"), {10, 11});
  open(other.string()).readPredictions(0, 2, labels_);
  EXPECT_EQ(labels_, Labels({10, 11}));
  expectMentions(errorOf([&] { open(other.string()).readPredictions(1, 1, labels_); }),
                 {"mine/sequences/04/predictions/000002.label"});
  expectMentions(errorOf([&] { open((root_ / "none").string()); }), {"none/sequences/04/predictions"});
  expectMentions(errorOf([&] { open().readPredictions(0, 2, labels_); }), {"no folder of predictions", "04"});
}

TEST_F(SemanticKittiFolder, NamesWhatIsBroken)
{
  writeBytes(sequence_ / "velodyne/000000.bin", std::string(37, 'x'));
  expectMentions(errorOf([&] { open().readScan(0, points_); }), {"velodyne/000000.bin", "16", "37"});
  expectMentions(errorOf([&] { open().readLabels(0, 5, labels_); }), {"labels/000000.label", "5", "2"});
  writeBytes(sequence_ / "labels/000000.label", std::string(7, 'x'));
  expectMentions(errorOf([&] { open().readLabels(0, 2, labels_); }), {"labels/000000.label", "4", "7"});
  fs::remove(sequence_ / "velodyne/000002.bin");
  expectMentions(errorOf([&] { open().readScan(1, points_); }), {"velodyne/000002.bin", "No such file"});
  fs::remove(sequence_ / "labels/000002.label");
  EXPECT_EQ(open().size(), 1U);

  expectMentions(errorOf([&] { SemanticKittiSequence(root_.string(), "05"); }), {"sequences/05"});
  expectMentions(errorOf([&] { semanticKittiSequences((root_ / "nowhere").string()); }), {"nowhere/sequences"});
  fs::create_directories(root_ / "empty/sequences/00/velodyne");
  expectMentions(errorOf([&] { SemanticKittiSequence((root_ / "empty").string(), "00"); }), {"00/velodyne", "no scan"});
  fs::remove(root_ / "empty/sequences/00/velodyne");
  expectMentions(errorOf([&] { semanticKittiSequences((root_ / "empty").string()); }), {"empty/sequences"});
}

TEST_F(SemanticKittiFolder, HasNoLabelsInTheTestSplit)
{
  fs::remove_all(sequence_ / "labels");
  EXPECT_FALSE(open().hasLabels());
  EXPECT_EQ(open().size(), 2U);
}

TEST_F(SemanticKittiFolder, PosesAreTheLidars)
{
  EXPECT_TRUE(open().readPoses().empty());
  EXPECT_TRUE(open().readTimes().empty());
  // camera: x right, y down, z ahead, 0.5 m before the lidar; it drives 2 m ahead by its third pose
  writeBytes(sequence_ / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.5\n");
  writeBytes(sequence_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  writeBytes(sequence_ / "times.txt", "0.0\n1.0e-01\n2.0e-01\n");
  EXPECT_TRUE(open().hasCalibration());
  const auto poses = open().readPoses();
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_TRUE(poses[0].matrix().isIdentity(1e-12));
  EXPECT_TRUE(poses[1].translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-12)) << "scan 000002 is the third line";
  EXPECT_EQ(open().readTimes(), std::vector<double>({0.0, 0.2}));

  writeBytes(sequence_ / "times.txt", "0.0\n");
  expectMentions(errorOf([&] { open().readTimes(); }), {"times.txt", "3", "1"});

  writeBytes(sequence_ / "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_FALSE(open().hasCalibration());
  EXPECT_TRUE(open().readPoses()[1].translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-12)) << "axes only";

  writeBytes(sequence_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1\n");
  expectMentions(errorOf([&] { open().readPoses(); }), {"poses.txt:1", "12"});
  writeBytes(sequence_ / "calib.txt", "Tr: 1 0 0\n");
  expectMentions(errorOf([&] { open().readPoses(); }), {"calib.txt:1", "12"});
  fs::remove(sequence_ / "calib.txt");
  expectMentions(errorOf([&] { open().readPoses(); }), {"calib.txt"});
}

TEST_F(SemanticKittiFolder, WritesLabelFilesWholeOrNotAtAll)
{
  const auto path = root_ / "out/sequences/04/predictions/000000.label";
  EXPECT_EQ(predictionFile((root_ / "out").string(), "04", "000000"), path.string());
  writeLabelFile(path.string(), {1, 2, 0xFFFFFFFF});
  readLabelFile(path.string(), labels_);
  EXPECT_EQ(labels_, Labels({1, 2, 0xFFFFFFFF}));
  EXPECT_EQ(listScanFiles(path.parent_path().string(), ".label"), std::vector<std::string>{"000000"});

  // a file-size limit fails the write half-way, as a full disk does
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit limit = before;
  limit.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &limit);
  const auto error = errorOf([&] { writeLabelFile(path.string(), Labels(1000, 7)); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  expectMentions(error, {"cannot write " + path.string(), "too large"});
  readLabelFile(path.string(), labels_);
  EXPECT_EQ(labels_, Labels({1, 2, 0xFFFFFFFF})) << "the old file stays";
  EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), {}), 1) << "nothing is left aside";

  writeBytes(root_ / "file", "x");
  expectMentions(errorOf([&] { writeLabelFile((root_ / "file/000000.label").string(), {1}); }), {"file/000000.label"});
}

TEST(SemanticKitti, HasTheOfficialSplits)
{
  EXPECT_EQ(semanticKittiSplit("train").size(), 10U);
  EXPECT_EQ(semanticKittiSplit("valid"), std::vector<std::string>{"08"});
  EXPECT_EQ(semanticKittiSplit("test").front(), "11");
  EXPECT_EQ(semanticKittiSplit("test").size(), 11U);
  EXPECT_THROW(semanticKittiSplit("all"), std::invalid_argument);
}

TEST(SemanticKitti, EncodesCanonicalIds)
{
  const auto table = ClassTable::load("semantic_kitti");
  Labels labels;
  encodeLabels({252, 60, 9999, 0x0007000A}, {5, 0, 0, 65535}, table, labels);
  EXPECT_EQ(labels, Labels({5U << 16U | 10U, 40, 0, 0xFFFF000A}));
  EXPECT_THROW(encodeLabels({10}, {65536}, table, labels), std::runtime_error);
  EXPECT_THROW(encodeLabels({10}, {}, table, labels), std::invalid_argument);
}

TEST(SemanticKitti, TheRecordedCarDrivesAhead)
{
  REQUIRE_RECORDED_DATA(data);
  const SemanticKittiSequence sequence(data + "/semantickitti", "00", data + "/semantickitti/predictions/mininet");
  const auto poses = sequence.readPoses();
  const auto times = sequence.readTimes();
  ASSERT_EQ(poses.size(), sequence.size());
  ASSERT_EQ(times.size(), sequence.size());
  EXPECT_TRUE(poses[0].matrix().isIdentity(1e-6));
  for (std::size_t i = 1; i < poses.size(); ++i)
  {
    const Eigen::Vector3d step = (poses[i - 1].inverse() * poses[i]).translation();
    EXPECT_GT(step.x(), 0.6) << i;
    EXPECT_LT(step.x(), 1.5) << i;
    EXPECT_LT(std::abs(step.y()), 0.1) << i;
    EXPECT_LT(std::abs(step.z()), 0.1) << i;
    EXPECT_NEAR(times[i] - times[i - 1], 0.1037, 0.001);
  }
  std::vector<ScanPoint> points;
  Labels labels;
  for (std::size_t i = 0; i < sequence.size(); ++i)
  {
    sequence.readScan(i, points);
    EXPECT_GT(points.size(), 100000U);
    sequence.readLabels(i, points.size(), labels);
    sequence.readPredictions(i, points.size(), labels);
  }
}
}  // namespace lidar_panoptic_clustering
