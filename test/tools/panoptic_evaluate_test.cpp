#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace
{
using Labels = std::vector<std::uint32_t>;

void write(const fs::path& path, const Labels& labels)
{
  fs::create_directories(path.parent_path());
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(labels.data()), static_cast<std::streamsize>(labels.size() * 4));
}

std::string read(const fs::path& path)
{
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Files begun and not finished, below a folder.
int partsLeft(const fs::path& folder)
{
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.path().extension() == ".part";
  return count;
}

/// Runs the program, which is built into the folder of this test, on a data set of two sequences of three scans of 100
/// points; a test disturbs it before.
class PanopticEvaluate : public testing::Test
{
protected:
  void SetUp() override
  {
    const char* given = std::getenv("PANOPTIC_EVALUATE");
    program_ = given != nullptr ? given : fs::read_symlink("/proc/self/exe").parent_path() / "panoptic_evaluate";
    ASSERT_TRUE(fs::exists(program_)) << program_ << " is not built";
    std::string pattern = (fs::temp_directory_path() / "panoptic_evaluate_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    for (const std::string sequence : {"03", "08"})
      for (std::uint32_t scan = 0; scan < 3; ++scan)
      {
        Labels labels(100, 40);
        for (std::uint32_t i = 0; i < 60; ++i) labels[i] = (7 + scan) << 16U | 10U;
        write(truth(sequence, scan), labels);
        for (std::uint32_t i = 0; i < 10 * scan; ++i) labels[i] = 0;  // IoU 1, 5/6, 2/3
        write(prediction(sequence, scan), labels);
      }
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path truth(const std::string& sequence, std::uint32_t scan) const
  {
    return folder_ / "data/sequences" / sequence / "labels" / ("00000" + std::to_string(scan) + ".label");
  }
  fs::path prediction(const std::string& sequence, std::uint32_t scan) const
  {
    return folder_ / "found/sequences" / sequence / "predictions" / ("00000" + std::to_string(scan) + ".label");
  }

  /// Exit status; what the program prints is in out() and err() afterwards.
  int run(const std::string& arguments) const
  {
    const std::string command =
        "cd '" + folder_.string() + "' && '" + program_.string() + "' " + arguments + " >out.txt 2>err.txt";
    return WEXITSTATUS(std::system(command.c_str()));
  }
  int evaluate(const std::string& more = "") const { return run("--dataset data --predictions found " + more); }
  std::string out() const { return read(folder_ / "out.txt"); }
  std::string err() const { return read(folder_ / "err.txt"); }
  nlohmann::json report(const std::string& name) const { return nlohmann::json::parse(read(folder_ / name)); }

  /// Expects failure, `parts` of the message, and no report.
  void expectFailure(const std::string& more, const std::vector<std::string>& parts) const
  {
    EXPECT_EQ(evaluate("--report r.json " + more), 1);
    for (const std::string& part : parts) EXPECT_NE(err().find(part), std::string::npos) << part << "\n" << err();
    EXPECT_FALSE(fs::exists(folder_ / "r.json"));
    EXPECT_EQ(partsLeft(folder_), 0);
  }

  fs::path folder_, program_;
};

TEST_F(PanopticEvaluate, FiguresOfAllSequences)
{
  ASSERT_EQ(evaluate("--report r.json"), 0) << err();
  const auto r = report("r.json");
  EXPECT_EQ(r.at("scans"), 6);
  EXPECT_EQ(r.at("per_class").at("car").at("tp"), 6);
  EXPECT_DOUBLE_EQ(r.at("per_class").at("car").at("pq"), 2.5 / 3.0);
  EXPECT_DOUBLE_EQ(r.at("pq_th_present"), 2.5 / 3.0);
  EXPECT_DOUBLE_EQ(r.at("per_class").at("road").at("pq"), 1.0);
  EXPECT_EQ(r.at("true_objects").at("matched"), 6);
  EXPECT_EQ(r.at("scans_skipped"), 0);
  EXPECT_NE(out().find("car                83.3"), std::string::npos) << out();
}

TEST_F(PanopticEvaluate, SequencesAndSplit)
{
  ASSERT_EQ(evaluate("--sequences 03 --report a.json"), 0) << err();
  EXPECT_EQ(report("a.json").at("scans"), 3);
  ASSERT_EQ(evaluate("--split valid --report b.json"), 0) << err();
  EXPECT_EQ(report("b.json").at("scans"), 3);
  expectFailure("--split valid --sequences 03", {"--sequences and --split"});
  expectFailure("--split all", {"'all'"});
  expectFailure("--sequences 03,03", {"03 is given twice"});
}

TEST_F(PanopticEvaluate, JobsAndMergeGiveTheSameBytes)
{
  ASSERT_EQ(evaluate("--jobs 1 --report one.json"), 0) << err();
  ASSERT_EQ(evaluate("--jobs 2 --report two.json"), 0) << err();
  EXPECT_EQ(read(folder_ / "one.json"), read(folder_ / "two.json"));

  ASSERT_EQ(evaluate("--sequences 08 --report a.json"), 0) << err();
  ASSERT_EQ(evaluate("--sequences 03 --report b.json"), 0) << err();
  ASSERT_EQ(run("--merge a.json b.json --report merged.json"), 0) << err();
  EXPECT_EQ(read(folder_ / "one.json"), read(folder_ / "merged.json"));
}

TEST_F(PanopticEvaluate, MergeRefusesWhatIsNoReport)
{
  ASSERT_EQ(evaluate("--report a.json"), 0) << err();
  ASSERT_EQ(evaluate("--min-points 9 --report b.json"), 0) << err();
  EXPECT_EQ(run("--merge a.json b.json"), 1);
  EXPECT_NE(err().find("min_points 50 and 9"), std::string::npos) << err();
  EXPECT_EQ(run("--merge a.json out.txt"), 1);
  EXPECT_NE(err().find("out.txt: not JSON"), std::string::npos) << err();
  EXPECT_EQ(run("--merge a.json none.json"), 1);
  EXPECT_NE(err().find("none.json"), std::string::npos) << err();
}

TEST_F(PanopticEvaluate, ReportsThatNestOrNeverEndAreRefused)
{
  std::ofstream(folder_ / "deep.json") << R"({"class_table":"semantic_kitti","min_points":)" << std::string(200000, '[')
                                       << std::string(200000, ']') << "}";
  EXPECT_EQ(run("--merge deep.json"), 1);
  EXPECT_NE(err().find("deep.json: nested more than 64 deep"), std::string::npos) << err();
  EXPECT_EQ(run("--merge /dev/zero"), 1);
  EXPECT_NE(err().find("/dev/zero: expected a file, found a device"), std::string::npos) << err();
  EXPECT_EQ(std::system(("mkfifo " + (folder_ / "pipe").string()).c_str()), 0);
  EXPECT_EQ(run("--merge pipe"), 1);
  EXPECT_NE(err().find("pipe: expected a file, found a pipe"), std::string::npos) << err();
  fs::remove(prediction("08", 1));
  fs::rename(folder_ / "pipe", prediction("08", 1));
  expectFailure("", {"08/predictions/000001.label: expected a file, found a pipe"});
}

TEST_F(PanopticEvaluate, WhatAReportSaysMovesNoCursor)
{
  std::ofstream(folder_ / "a.json") << "{\"class_table\": \"\\u001b[2Jx\"}";
  EXPECT_EQ(run("--merge a.json"), 1);
  EXPECT_EQ(err().find('\x1b'), std::string::npos);
  EXPECT_NE(err().find("\\x1b[2Jx"), std::string::npos) << err();
}

TEST_F(PanopticEvaluate, SequencesStayBelowTheirFolder)
{
  for (const std::string& name : std::vector<std::string>{"../sequences/08", "..", ".", "/", folder_.string()})
    expectFailure("--sequences '" + name + "'", {"sequence '" + name + "'", "expected the name of one folder"});
}

TEST_F(PanopticEvaluate, ShortAndLongFiles)
{
  write(prediction("08", 1), Labels(99, 40));
  expectFailure("", {"found/sequences/08/predictions/000001.label", "expected 100", "found 99"});
  write(prediction("08", 1), Labels(101, 40));
  expectFailure("", {"000001.label", "expected 100", "found 101"});
  std::ofstream(prediction("08", 1), std::ios::app) << "x";
  expectFailure("", {"000001.label", "multiple of 4", "405"});
}

TEST_F(PanopticEvaluate, TruthMustFitTheScanWhereThereIsOne)
{
  write(folder_ / "data/sequences/08/velodyne/000000.bin", Labels(4 * 101));
  expectFailure("", {"data/sequences/08/labels/000000.label", "expected 101", "found 100"});
}

TEST_F(PanopticEvaluate, ScanWithoutPredictionAndPredictionWithoutScan)
{
  fs::rename(prediction("03", 2), prediction("03", 7));
  expectFailure("", {"03/predictions/000007.label", "without its scan"});
  fs::remove(prediction("03", 7));
  expectFailure("", {"03/predictions/000002.label"});
}

TEST_F(PanopticEvaluate, UnknownClass)
{
  Labels labels(100, 40);
  labels[17] = 3U << 16U | 777U;
  write(prediction("03", 0), labels);
  expectFailure("", {"03/predictions/000000.label", "point 17", "777", "semantic_kitti"});
}

TEST_F(PanopticEvaluate, TheFirstBadScanIsReportedWithAnyNumberOfJobs)
{
  for (std::uint32_t scan = 0; scan < 3; ++scan) write(prediction("08", scan), {});
  for (int i = 0; i < 5; ++i) expectFailure("--jobs 4", {"08/predictions/000000.label"});
}

TEST_F(PanopticEvaluate, KeepGoingSkipsAndCounts)
{
  write(prediction("08", 1), Labels(99, 40));
  fs::remove(prediction("03", 0));
  write(prediction("03", 7), Labels(100, 40));
  ASSERT_EQ(evaluate("--keep-going --jobs 2 --report two.json"), 0) << err();
  ASSERT_EQ(evaluate("--keep-going --jobs 1 --report one.json"), 0) << err();
  EXPECT_EQ(read(folder_ / "one.json"), read(folder_ / "two.json"));
  const auto r = report("one.json");
  EXPECT_EQ(r.at("scans"), 4);
  EXPECT_EQ(r.at("scans_skipped"), 3);
  EXPECT_EQ(r.at("skipped").at(0).at("scan"), "03/000000");
  EXPECT_EQ(r.at("skipped").at(1).at("scan"), "03/000007");
  EXPECT_EQ(r.at("skipped").at(2).at("scan"), "08/000001");
  EXPECT_NE(out().find("skipped: 3"), std::string::npos) << out();
}

TEST_F(PanopticEvaluate, TemporalFiguresAndTheirMerging)
{
  ASSERT_EQ(evaluate("--temporal --jobs 2 --report whole.json"), 0) << err();
  const auto temporal = report("whole.json").at("temporal");
  // a tube a scan of 60 points, of which 60, 50 and 40 are found
  EXPECT_NEAR(temporal.at("s_assoc").get<double>(), (1.0 + 2500.0 / 3600 + 1600.0 / 3600) / 3, 1e-12);
  // car 150 of 180, road 80 of 80 a sequence, and what is predicted to be ignored
  EXPECT_NEAR(temporal.at("s_cls").get<double>(), (150.0 / 180 + 1.0 + 0.0) / 3, 1e-12);
  EXPECT_NE(out().find("LSTQ 66.0, S_assoc 71.3, S_cls 61.1"), std::string::npos) << out();
  ASSERT_EQ(evaluate("--temporal --sequences 03 --report a.json"), 0) << err();
  ASSERT_EQ(evaluate("--temporal --sequences 08 --report b.json"), 0) << err();
  ASSERT_EQ(run("--merge b.json a.json --report merged.json"), 0) << err();
  EXPECT_EQ(read(folder_ / "merged.json"), read(folder_ / "whole.json"));
  ASSERT_EQ(evaluate("--sequences 08 --report plain.json"), 0) << err();
  EXPECT_EQ(run("--merge a.json plain.json"), 1);
  EXPECT_NE(err().find("temporal"), std::string::npos) << err();
}

TEST_F(PanopticEvaluate, NothingEvaluatedIsAFailure)
{
  for (std::uint32_t scan = 0; scan < 3; ++scan) write(prediction("08", scan), {});
  expectFailure("--sequences 08 --keep-going", {"none of the 3 scans"});
}

TEST_F(PanopticEvaluate, FoldersWithoutSequences)
{
  expectFailure("--sequences 04", {"data/sequences/04"});
  fs::remove_all(folder_ / "found/sequences/08");
  expectFailure("", {"found/sequences/08/predictions"});
  fs::remove_all(folder_ / "data/sequences/08/labels");
  fs::remove_all(folder_ / "data/sequences/03");
  expectFailure("", {"sequences"});
}

TEST_F(PanopticEvaluate, UnwritableReportAndFullDisk)
{
  EXPECT_EQ(evaluate("--report none/r.json"), 1);
  EXPECT_NE(err().find("cannot write none/r.json: No such file or directory"), std::string::npos) << err();
  fs::create_symlink("/dev/full", folder_ / "full.json");
  EXPECT_EQ(evaluate("--report full.json"), 1);
  EXPECT_NE(err().find("cannot write full.json: No space left"), std::string::npos) << err();
  fs::remove(folder_ / "full.json");
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer's own files are larger than 1 kB";
#endif
  // a disk that is full as soon as the report comes: files end at 1 kB, which takes the message but not the report
  std::ofstream(folder_ / "full.sh") << "trap '' XFSZ; ulimit -f 1; '" << program_.string()
                                     << "' --dataset data --predictions found --report full.json >out.txt 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(("cd '" + folder_.string() + "' && bash full.sh").c_str())), 1);
  EXPECT_NE(err().find("cannot write full.json: File too large"), std::string::npos) << err();
  EXPECT_FALSE(fs::exists(folder_ / "full.json"));
}

TEST_F(PanopticEvaluate, WrongOptions)
{
  EXPECT_EQ(run("--help"), 0);
  for (const std::string option : {"dataset", "predictions", "sequences", "split", "class-table", "min-points",
                                   "temporal", "jobs", "keep-going", "report", "merge"})
    EXPECT_NE(out().find("--" + option), std::string::npos) << option;
  EXPECT_EQ(run(""), 1);
  EXPECT_NE(err().find("--dataset is missing"), std::string::npos) << err();
  EXPECT_EQ(evaluate("--frobnicate"), 1);
  EXPECT_EQ(evaluate("stray"), 1);
  EXPECT_EQ(evaluate("--jobs 0"), 1);
  EXPECT_EQ(evaluate("--jobs many"), 1);
  EXPECT_EQ(evaluate("--min-points -1"), 1);
  EXPECT_EQ(evaluate("--class-table none.yaml"), 1);
  EXPECT_NE(err().find("none.yaml"), std::string::npos) << err();
}
}  // namespace
