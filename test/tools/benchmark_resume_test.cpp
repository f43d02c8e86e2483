// What goes on in a folder of predictions that is there, and what is refused.
#include "benchmark_fixture.h"

namespace lidar_panoptic_clustering
{
namespace
{
class BenchmarkResume : public PanopticBenchmark
{
protected:
  void writeTable(const std::string& link, const std::string& note = "") const
  {
    std::ofstream(folder_ / "table.yaml")
        << "# " << note << "\nclasses:\n"
        << "  - {name: car, kind: thing, ids: [10, 252], color: [1, 2, 3], size: [5, 2], link: " << link << "}\n"
        << "  - {name: road, kind: stuff, ids: [40], color: [1, 2, 3]}\n";
  }
  const std::string with_table_ = "--algorithms birds_eye --class-table table.yaml --output out";
};

TEST_F(BenchmarkResume, AnotherContentOfTheClassTableIsRefused)
{
  writeTable("0.8");
  ASSERT_EQ(benchmark(with_table_), 0) << err();
  writeTable("0.8", "a comment is no other content");
  ASSERT_EQ(benchmark(with_table_), 0) << err();
  writeTable("30");
  expectFailure(with_table_,
                {"out/birds_eye holds predictions with 'class table: table.yaml, content ", "choose another --output"});
}

TEST_F(BenchmarkResume, AnotherScanOfTheSameNameIsRefused)
{
  ASSERT_EQ(benchmark("--algorithms depth --output out"), 0) << err();
  std::vector<float> points(800, 7.0F);
  write(scanFile("08", 1), points);
  expectFailure("--algorithms depth --output out --keep-going",
                {"out/depth/sequences/08/predictions/000001.label was made of another scan"});
  writeScan("08", 1);
  ASSERT_EQ(benchmark("--algorithms depth --output out"), 0) << err();
  Labels labels = readLabels(truth("03", 2));
  labels[0] = kRoad;
  write(truth("03", 2), labels);
  expectFailure("--algorithms depth --output out", {"03/predictions/000002.label was made of another scan"});
}

/// The same scans in another place are the same data set.
TEST_F(BenchmarkResume, AMovedDataSetGoesOn)
{
  ASSERT_EQ(benchmark("--algorithms depth --output out"), 0) << err();
  const auto kept = fs::last_write_time(output("depth", "08", 0));
  fs::rename(folder_ / "data", folder_ / "moved");
  ASSERT_EQ(run("--dataset moved --columns 512 --algorithms depth --output out"), 0) << err();
  EXPECT_EQ(fs::last_write_time(output("depth", "08", 0)), kept);
}

TEST_F(BenchmarkResume, AnotherVersionIsRefused)
{
  ASSERT_EQ(benchmark("--algorithms depth --output out"), 0) << err();
  std::string settings = read(folder_ / "out/depth.settings");
  const std::size_t line = settings.find("version: ");
  ASSERT_NE(line, std::string::npos) << settings;
  std::ofstream(folder_ / "out/depth.settings") << settings.substr(0, line) << "version: 0.0.1\n";
  expectFailure("--algorithms depth --output out", {"'version: 0.0.1'", "'version: "});
  std::ofstream(folder_ / "out/depth.settings") << settings << "one more: 1\n";
  expectFailure("--algorithms depth --output out", {"'one more: 1'"});
}

TEST_F(BenchmarkResume, ShardsStartedAtOnceShareANewFolder)
{
  std::ofstream(folder_ / "shards.sh") << "for i in 1 2 3 4; do\n"
                                       << "  '" << program_.string() << "' --dataset data --columns 512 --algorithms "
                                       << "depth --output out --shard $i/4 >/dev/null 2>>err.txt & all=\"$all $!\"\n"
                                       << "done\n"
                                       << "for p in $all; do wait $p || exit 1; done\n";
  for (int i = 0; i < 5; ++i)
  {
    fs::remove_all(folder_ / "out");
    EXPECT_EQ(std::system(("cd '" + folder_.string() + "' && bash shards.sh").c_str()), 0) << err();
    EXPECT_EQ(partsLeft(folder_), 0);
  }
  EXPECT_TRUE(fs::exists(output("depth", "08", 2)));
}

TEST_F(BenchmarkResume, SequencesStayBelowTheirFolder)
{
  fs::create_directories(folder_ / "other/sequences");
  const std::string absolute = sequenceFolder("08").string();
  for (const std::string& name : {absolute, std::string("../../data/sequences/08"), std::string("..")})
  {
    EXPECT_EQ(run("--dataset other --algorithms depth --output out --sequences '" + name + "'"), 1);
    EXPECT_NE(err().find("expected the name of one folder below 'sequences'"), std::string::npos) << err();
  }
  EXPECT_FALSE(fs::exists(sequenceFolder("08") / "predictions"));
}

TEST_F(BenchmarkResume, NamesOfAnyBytesKeepTheirTimes)
{
  const std::string names[] = {"a,b;c%2C", std::string("two\nlines"), std::string(200, 'n')};
  for (std::uint32_t i = 0; i < 3; ++i)
  {
    fs::rename(scanFile("08", i), scanFile("08", 0).parent_path() / (names[i] + ".bin"));
    fs::rename(truth("08", i), truth("08", 0).parent_path() / (names[i] + ".label"));
  }
  ASSERT_EQ(benchmark("--algorithms depth --output out --report a.json"), 0) << err();
  ASSERT_EQ(benchmark("--algorithms depth --output out --report b.json"), 0) << err();
  EXPECT_EQ(report("a.json").at("times").at("depth").at("frames").size(), 6U);
  EXPECT_EQ(report("a.json").at("times"), report("b.json").at("times"));
}
}  // namespace
}  // namespace lidar_panoptic_clustering
