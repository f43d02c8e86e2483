#include "benchmark_fixture.h"

namespace lidar_panoptic_clustering
{
namespace
{
TEST_F(PanopticBenchmark, OutputOfOtherSettingsIsNotMixedIn)
{
  ASSERT_EQ(benchmark("--algorithms euclidean --output out"), 0) << err();
  expectFailure("--algorithms euclidean --output out --semantics net",
                {"out/euclidean holds predictions with 'semantics: ground truth'", "'semantics: net'"});
  ASSERT_EQ(benchmark("--algorithms euclidean --set euclidean.distance_m=0.4 --output out"), 0) << err();
  EXPECT_TRUE(fs::exists(output("euclidean_distance_m=0.4", "03", 0)));
}

TEST_F(PanopticBenchmark, WithoutGroundTruthItStillPredicts)
{
  fs::remove_all(sequenceFolder("08") / "labels");
  expectFailure("--sequences 08", {"sequence 08", "'labels'", "--semantics"});
  ASSERT_EQ(benchmark("--sequences 08 --semantics net --algorithms depth --output out"), 0) << err();
  EXPECT_NE(out().find("no ground truth"), std::string::npos) << out();
  EXPECT_TRUE(fs::exists(output("depth", "08", 2)));
}

TEST_F(PanopticBenchmark, WrongFilesAreNamed)
{
  write(semantics("08", 1), Labels(199, kRoad));
  expectFailure("--semantics net", {"net/sequences/08/predictions/000001.label", "expected 200", "found 199"});
  write(semantics("08", 1), Labels(201, kRoad));
  expectFailure("--semantics net", {"000001.label", "expected 200", "found 201"});
  write(semantics("08", 1), Labels(200, 777));
  expectFailure("--semantics net", {"000001.label", "777", "semantic_kitti"});
  fs::rename(semantics("08", 1), semantics("08", 7));
  expectFailure("--semantics net", {"08/predictions/000007.label", "without its scan"});
  fs::remove(semantics("08", 7));
  expectFailure("--semantics net", {"08/predictions/000001.label"});
  write(truth("03", 2), Labels(5, kRoad));
  expectFailure("", {"03/labels/000002.label", "expected 200", "found 5"});
  fs::resize_file(scanFile("03", 0), 33);
  expectFailure("", {"03/velodyne/000000.bin", "33"});
  expectFailure("--sequences 04", {"data/sequences/04"});
}

TEST_F(PanopticBenchmark, KeepGoingSkipsAndCounts)
{
  write(semantics("08", 1), Labels(199, kRoad));
  fs::remove(scanFile("03", 0));
  write(semantics("03", 7), Labels(200, kRoad));
  ASSERT_EQ(benchmark("--semantics net --keep-going --jobs 2 --report kept.json"), 0) << err();
  const auto q = report("kept.json").at("quality").at("rows").at("depth");
  EXPECT_EQ(q.at("scans"), 4);
  EXPECT_EQ(q.at("scans_skipped"), 3);
  EXPECT_EQ(q.at("skipped").at(0).at("scan"), "03/000000");
  EXPECT_NE(out().find("3 skipped"), std::string::npos) << out();
  for (std::uint32_t scan = 0; scan < 3; ++scan) fs::remove(truth("08", scan)), write(truth("08", scan), Labels{});
  expectFailure("--sequences 08 --keep-going", {"none of the 3 scans"});
}

TEST_F(PanopticBenchmark, WhatCannotBeWrittenIsNamed)
{
  std::ofstream(folder_ / "file") << "x";
  expectFailure("--output file", {"cannot write file/euclidean"});
  EXPECT_EQ(benchmark("--report none/r.json"), 1);
  EXPECT_NE(err().find("cannot write none/r.json: No such file or directory"), std::string::npos) << err();
  EXPECT_EQ(benchmark("--algorithms depth --report /dev/full"), 1);
  EXPECT_NE(err().find("cannot write /dev/full: No space left"), std::string::npos) << err();
  EXPECT_NE(out().find("\ndepth "), std::string::npos) << "the figures are printed before they are lost";
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  ASSERT_EQ(benchmark("--algorithms depth --output out --limit 1"), 0) << err();
  fs::create_symlink("/dev/full", output("depth", "03", 1));
  expectFailure("--algorithms depth --output out --keep-going", {"03/predictions/000001.label: No space left"});
}

TEST_F(PanopticBenchmark, WrongOptions)
{
  EXPECT_EQ(run("--help"), 0);
  for (const std::string option : {"dataset", "sequences", "split", "semantics", "algorithms", "set", "jobs", "shard",
                                   "limit", "output", "report", "plot", "class-table", "columns", "keep-going"})
    EXPECT_NE(out().find("--" + option), std::string::npos) << option;
  EXPECT_EQ(run(""), 1);
  expectFailure("--algorithms sonar", {"no algorithm 'sonar'", "scan_line_run"});
  expectFailure("--set depth.theta=5", {"no parameter 'theta'", "theta_deg"});
  expectFailure("--set depth.theta_deg=5,190", {"theta_deg", "190", "89"});
  expectFailure("--algorithms euclidean --set depth.theta_deg=5", {"no row runs algorithm 'depth'"});
  expectFailure("--set theta_deg=5", {"algorithm.parameter=value"});
  expectFailure("--shard 3/2", {"--shard is '3/2'"});
  expectFailure("--shard 1", {"--shard is '1'"});
  expectFailure("--jobs 0", {"--jobs is 0"});
  expectFailure("--limit -1", {"--limit is -1"});
  EXPECT_EQ(run("--dataset data --columns 3"), 1);
  EXPECT_NE(err().find("--columns is 3"), std::string::npos) << err();
  expectFailure("--split 08", {"'08'"});
  expectFailure("--class-table none.yaml", {"none.yaml"});
  EXPECT_EQ(benchmark("stray"), 1);
  EXPECT_EQ(benchmark("--algo depth"), 1);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
