#include "benchmark_fixture.h"
#include "lidar_panoptic_clustering/pipeline/factory.h"
#include "recorded_data.h"

#include <algorithm>
#include <utility>

namespace lidar_panoptic_clustering
{
namespace
{
TEST_F(PanopticBenchmark, AllRowsOnAllSequences)
{
  ASSERT_EQ(benchmark("--report r.json"), 0) << err();
  const auto r = report("r.json");
  std::vector<std::string> rows = algorithmNames();  // and for supervoxel a second row
  rows.insert(std::find(rows.begin(), rows.end(), "supervoxel") + 1, "supervoxel normal_weight=0.5");
  EXPECT_EQ(r.at("rows").get<std::vector<std::string>>(), rows);
  for (const std::string& row : rows)
  {
    EXPECT_NE(out().find("\n" + row + " "), std::string::npos) << out();
    EXPECT_EQ(r.at("quality").at("rows").at(row).at("scans"), 6);
    EXPECT_EQ(r.at("times").at(row).at("frames").size(), 6U);
    EXPECT_GT(r.at("times").at(row).at("pipeline_ms").at("max"), 0.0);
  }
  const auto& euclidean = r.at("quality").at("rows").at("euclidean");
  EXPECT_EQ(euclidean.at("pq_th_present"), 1.0);
  EXPECT_EQ(euclidean.at("per_class").at("car").at("tp"), 12);
  EXPECT_EQ(euclidean.at("true_objects").at("matched"), 12);
  EXPECT_EQ(r.at("quality").at("before_clustering").at("miou"), euclidean.at("miou"));
  EXPECT_EQ(r.at("quality").at("scans").at("08"), 3);
}

TEST_F(PanopticBenchmark, SweepGivesARowAValue)
{
  ASSERT_EQ(benchmark("--survey --algorithms euclidean --set euclidean.distance_m=0.5,3 euclidean.min_points=1,61 "
                      "--report r.json"),
            0)
      << err();
  const auto r = report("r.json");
  ASSERT_EQ(r.at("rows").size(), 4U);
  EXPECT_EQ(r.at("rows").at(0), "euclidean survey distance_m=0.5 min_points=1");
  EXPECT_EQ(r.at("rows").at(1), "euclidean survey distance_m=0.5 min_points=61");
  const auto& merged = r.at("quality").at("rows").at("euclidean survey distance_m=3 min_points=1");
  EXPECT_EQ(merged.at("true_objects").at("merged"), 12);
  EXPECT_EQ(merged.at("pq_th_present"), 0.0);
}

TEST_F(PanopticBenchmark, TrackedIdsLastAndAreMeasured)
{
  ASSERT_EQ(benchmark("--algorithms euclidean --track --jobs 2 --output out --report r.json"), 0) << err();
  const auto euclidean = report("r.json").at("quality").at("rows").at("euclidean");
  EXPECT_EQ(euclidean.at("temporal").at("lstq"), 1.0);
  EXPECT_EQ(euclidean.at("temporal").at("tubes_per_class").at("car"), 4);
  EXPECT_EQ(euclidean.at("id_switches"), 0);
  EXPECT_EQ(euclidean.at("pq_th_present"), 1.0);
  EXPECT_NE(out().find("LSTQ"), std::string::npos) << out();
  for (const std::string sequence : {"03", "08"})
    for (std::uint32_t scan = 0; scan < 3; ++scan)
    {
      const Labels labels = readLabels(output("euclidean", sequence, scan));
      EXPECT_EQ(labels.front(), 1U << 16U | kCar) << sequence << " " << scan;
      EXPECT_EQ(labels.at(60), 2U << 16U | kCar) << sequence << " " << scan;
    }
  ASSERT_EQ(benchmark("--algorithms euclidean --track --output out --report again.json"), 0) << err();
  EXPECT_EQ(quality("again.json"), quality("r.json"));
  fs::remove(folder_ / "r.json");
  expectFailure("--track --shard 1/2", {"--track", "--shard"});
}

TEST_F(PanopticBenchmark, SwitchesGiveARowAStepAndReportsCompare)
{
  const std::string row = "--algorithms depth --set depth.theta_deg=5 ";
  ASSERT_EQ(benchmark(row + "--sequences 03 --switches --semantics net --report a.json"), 0) << err();
  ASSERT_EQ(benchmark(row + "--sequences 08 --switches --semantics net --report b.json"), 0) << err();
  const auto r = report("a.json");
  const std::vector<std::string> rows = {
      "depth theta_deg=5",
      "depth theta_deg=5, no step",
      "depth theta_deg=5, only bridge",
      "depth theta_deg=5, only split",
      "depth theta_deg=5, only merge",
      "depth theta_deg=5, only vote",
      "depth theta_deg=5, all but bridge",
      "depth theta_deg=5, all but split",
      "depth theta_deg=5, all but merge",
      "depth theta_deg=5, all but vote",
  };
  EXPECT_EQ(r.at("rows").get<std::vector<std::string>>(), rows);

  ASSERT_EQ(benchmark("--algorithms depth --set depth.theta_deg=5 depth.bridge_distance_m=0 depth.split=false "
                      "depth.merge=false depth.vote=true --sequences 03 --semantics net --report vote.json"),
            0)
      << err();
  const auto vote = report("vote.json").at("quality").at("rows");
  EXPECT_EQ(r.at("quality").at("rows").at(rows[5]), vote.at(vote.begin().key()));

  ASSERT_EQ(run("--compare a.json b.json"), 0) << err();
  EXPECT_NE(out().find("       a       b"), std::string::npos) << out();
  EXPECT_NE(out().find("\ndepth theta_deg=5, all but vote   "), std::string::npos) << out();
  EXPECT_NE(out().find("100.0   100.0"), std::string::npos) << out();

  EXPECT_EQ(benchmark("--survey --switches"), 1);
  EXPECT_NE(err().find("exclude each other"), std::string::npos) << err();
  EXPECT_EQ(benchmark("--switches --set depth.vote=false"), 1);
  EXPECT_NE(err().find("--switches sets vote itself"), std::string::npos) << err();
  EXPECT_EQ(run("--compare a.json vote.json"), 1);
  EXPECT_NE(err().find("expected the rows of a in vote, found others"), std::string::npos) << err();
}

TEST_F(PanopticBenchmark, PredictionFilesHoldCanonicalClassesAndInstances)
{
  ASSERT_EQ(benchmark("--semantics net --algorithms euclidean --output out"), 0) << err();
  const Labels labels = readLabels(output("euclidean", "08", 1));
  ASSERT_EQ(labels.size(), 200U);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(labels[i] & 0xFFFFU, i < 120 ? kCar : kRoad) << i;
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(labels[i] >> 16U, labels[i < 60 ? 0 : i < 120 ? 60 : 120] >> 16U);
  EXPECT_NE(labels[0] >> 16U, 0U);
  EXPECT_NE(labels[60] >> 16U, 0U);
  EXPECT_NE(labels[0], labels[60]);
  EXPECT_EQ(labels[120] >> 16U, 0U);
}

TEST_F(PanopticBenchmark, TheLabelTableSaysWhatPredictedIdsMean)
{
  ASSERT_EQ(benchmark("--semantics net --algorithms euclidean --output out"), 0) << err();
  fs::rename(folder_ / "out", folder_ / "raw");
  for (const std::string sequence : {"03", "08"})
    for (std::uint32_t scan = 0; scan < 3; ++scan)
    {
      Labels labels = readLabels(semantics(sequence, scan));
      for (std::uint32_t& label : labels) label = label == kRoad ? 9 : label == kCar ? 1 : 20;
      write(semantics(sequence, scan), labels);
    }
  expectFailure("--semantics net",
                {"000000.label: expected class ids of the table 'semantic_kitti'", "'semantic_kitti_training'"});
  expectFailure("--semantics net --label-table nuscenes_training_less_one", {"'nuscenes_training_less_one'", "20 ("});
  expectFailure("--semantics net --label-table no_such_table", {"no_such_table"});
  expectFailure("--label-table semantic_kitti_training", {"--label-table", "--semantics", "not given"});
  ASSERT_EQ(benchmark("--semantics net --label-table semantic_kitti_training --algorithms euclidean --output out"), 0)
      << err();
  for (const std::string sequence : {"03", "08"})
    for (std::uint32_t scan = 0; scan < 3; ++scan)
    {
      const fs::path file = output("euclidean", sequence, scan);
      EXPECT_EQ(read(file), read(folder_ / "raw" / fs::relative(file, folder_ / "out"))) << file;
    }
}

TEST_F(PanopticBenchmark, JobsGiveTheSameBytes)
{
  ASSERT_EQ(benchmark("--jobs 1 --output out --report one.json"), 0) << err();
  fs::rename(folder_ / "out", folder_ / "first");
  ASSERT_EQ(benchmark("--jobs 2 --output out --report two.json"), 0) << err();
  EXPECT_EQ(quality("one.json"), quality("two.json"));
  std::size_t files = 0;
  for (const auto& file : fs::recursive_directory_iterator(folder_ / "first"))
  {
    if (file.path().extension() != ".label") continue;
    EXPECT_EQ(read(file.path()), read(folder_ / "out" / fs::relative(file.path(), folder_ / "first")));
    ++files;
  }
  EXPECT_EQ(files, 36U);
}

TEST_F(PanopticBenchmark, ShardsMergeToTheWhole)
{
  ASSERT_EQ(benchmark("--report whole.json"), 0) << err();
  ASSERT_EQ(benchmark("--shard 1/4 --report a.json"), 0) << err();
  EXPECT_EQ(report("a.json").at("quality").at("before_clustering").at("scans"), 2);
  std::string merge = "--merge a.json";
  for (const std::string i : {"2", "3", "4"})
  {
    ASSERT_EQ(benchmark("--shard " + i + "/4 --report " + i + ".json"), 0) << err();
    merge += " " + i + ".json";
  }
  ASSERT_EQ(run(merge + " --report merged.json"), 0) << err();
  EXPECT_EQ(quality("whole.json"), quality("merged.json"));
  EXPECT_EQ(report("merged.json").at("times").at("depth").at("frames").size(), 6U);

  EXPECT_EQ(run(merge + " a.json"), 1);
  EXPECT_NE(err().find("both hold scan 03/000000"), std::string::npos) << err();
  ASSERT_EQ(benchmark("--algorithms depth --report depth.json"), 0) << err();
  EXPECT_EQ(run("--merge a.json depth.json"), 1);
  EXPECT_EQ(run("--merge a.json err.txt"), 1);
  EXPECT_NE(err().find("err.txt: not JSON"), std::string::npos) << err();
}

TEST_F(PanopticBenchmark, KilledAndRerunGivesTheSameReport)
{
  ASSERT_EQ(benchmark("--report whole.json"), 0) << err();
  ASSERT_EQ(benchmark("--limit 2 --output out --report part.json"), 0) << err();
  // killed: one prediction is missing, one is half there, one was being written aside, one row lacks all times
  fs::remove(output("depth", "03", 0));
  fs::resize_file(output("euclidean", "03", 1), 100);
  std::ofstream(output("euclidean", "08", 2).string() + ".part") << "half";
  fs::remove(folder_ / "out/supervoxel.times.csv");
  std::ofstream(folder_ / "out/depth.times.csv", std::ios::app) << "08/0000";
  const auto kept = fs::last_write_time(output("depth", "08", 0));
  ASSERT_EQ(benchmark("--output out --report again.json"), 0) << err();
  EXPECT_EQ(quality("whole.json"), quality("again.json"));
  EXPECT_EQ(fs::last_write_time(output("depth", "08", 0)), kept);
  EXPECT_EQ(report("again.json").at("times").at("scan_line_run").at("frames").size(), 6U);
  EXPECT_EQ(report("again.json").at("times").at("supervoxel").at("frames").size(), 2U);
  const nlohmann::json first = report("part.json").at("times").at("scan_line_run").at("frames").at(0);
  EXPECT_EQ(report("again.json").at("times").at("scan_line_run").at("frames").at(0), first);

  ASSERT_EQ(benchmark("--output out --report third.json"), 0) << err();
  EXPECT_EQ(report("again.json").at("times").at("depth"), report("third.json").at("times").at("depth"));
}

TEST_F(PanopticBenchmark, InterruptEndsWithTheFiguresSoFar)
{
  for (std::uint32_t scan = 3; scan < 200; ++scan)
    for (const auto& [from, to] : {std::pair{scanFile("08", 0), scanFile("08", 0).parent_path() / "x.bin"},
                                   std::pair{truth("08", 0), truth("08", 0).parent_path() / "x.label"}})
    {
      std::string name = std::to_string(scan);
      name.insert(0, 6 - name.size(), '0');
      fs::create_symlink(from, to.parent_path() / (name + to.extension().string()));
    }
  std::ofstream(folder_ / "run.sh") << "'" << program_.string() << "' --dataset data --sequences 08 --output out"
                                    << " --report r.json >out.txt 2>err.txt &\n"
                                    << "for i in $(seq 1000); do\n"
                                    << "  test -e out/depth/sequences/08/predictions/000002.label && break\n"
                                    << "  sleep 0.01\n"
                                    << "done\n"
                                    << "kill -INT $!\n"
                                    << "wait $!\n";
  const int status = std::system(("cd '" + folder_.string() + "' && bash run.sh").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130) << err();
  EXPECT_NE(out().find("interrupted"), std::string::npos) << out();
  const auto r = report("r.json");
  EXPECT_EQ(r.at("interrupted"), true);
  const std::size_t scans = r.at("quality").at("before_clustering").at("scans");
  EXPECT_GE(scans, 2U);
  EXPECT_LT(scans, 200U);
  EXPECT_EQ(r.at("quality").at("rows").at("depth").at("scans"), scans);
  EXPECT_EQ(r.at("times").at("depth").at("frames").size(), scans);
}

TEST_F(PanopticBenchmark, Plots)
{
  if (std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") != 0) GTEST_SKIP() << "no matplotlib";
  ASSERT_EQ(benchmark("--survey --algorithms euclidean,depth --set euclidean.distance_m=0.5,3 --plot charts"), 0)
      << err();
  for (const std::string name : {"quality", "objects", "pq_by_class", "time", "time_by_points"})
    for (const std::string ending : {".png", ".svg"})
      EXPECT_GT(read(folder_ / "charts" / (name + ending)).size(), 1000U) << name << ending;
  EXPECT_GT(read(folder_ / "charts/scan_03_000000.png").size(), 1000U);
  EXPECT_EQ(report("charts/report.json").at("rows").size(), 3U);
  EXPECT_EQ(partsLeft(folder_), 0);
}

TEST_F(PanopticBenchmark, WithoutMatplotlibItSaysWhatToInstallAndTheReportIsThere)
{
  write(folder_ / "none/matplotlib/__init__.py", std::vector<char>{'1', '/', '0'});
  setenv("PYTHONPATH", (folder_ / "none").c_str(), 1);
  const int status = benchmark("--algorithms depth --report r.json --plot charts");
  unsetenv("PYTHONPATH");
  EXPECT_EQ(status, 1);
  EXPECT_NE(err().find("apt-get install python3-matplotlib"), std::string::npos) << err();
  EXPECT_NE(err().find("python3 -m lidar_panoptic_clustering plot --output charts r.json"), std::string::npos) << err();
  EXPECT_NE(out().find("\ndepth "), std::string::npos) << out();
  EXPECT_EQ(report("r.json").at("quality").at("scans").at("08"), 3);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "charts"), fs::directory_iterator{}), 0);
}

TEST_F(PanopticBenchmark, WithoutLabelsItPrintsAndDrawsWhatWasFound)
{
  ASSERT_EQ(benchmark("--labels none --structure strict --plot worst"), 0) << err();
  for (const char* part : {"structure strict", "lost  merged", "False segments", "Ground: precision", "CPU a scan"})
    EXPECT_NE(out().find(part), std::string::npos) << part << "\n" << out();
  std::size_t figures = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder_ / "worst"))
    figures += read(file.path()).size() > 1000U ? 1U : 0U;
  EXPECT_GT(figures, 0U);
  EXPECT_LE(figures, 10U);
}

/// Clusters of the recorded scans, written and evaluated again by the other program.
TEST_F(PanopticBenchmark, RecordedScansAgreeWithPanopticEvaluate)
{
  REQUIRE_RECORDED_DATA(data);
  const std::string dataset = fs::absolute(fs::path(data) / "semantickitti").string();
  ASSERT_EQ(run("--dataset '" + dataset + "' --limit 1 --algorithms depth --output out --report r.json"), 0) << err();
  const auto expected = report("r.json").at("quality").at("rows").at("depth");
  fs::create_directories(folder_ / "one/sequences");
  for (const std::string sequence : {"00", "05", "07"})
  {
    const fs::path to = folder_ / "one/sequences" / sequence / "labels";
    fs::create_directories(to);
    fs::copy_file(dataset + "/sequences/" + sequence + "/labels/000000.label", to / "000000.label");
  }
  program_.replace_filename("panoptic_evaluate");
  ASSERT_EQ(run("--dataset one --predictions out/depth --report e.json"), 0) << err();
  EXPECT_EQ(report("e.json"), expected);
  EXPECT_GT(expected.at("pq_th_present"), 0.8);
  EXPECT_GT(expected.at("pq_st"), 0.95);
}
}  // namespace
}  // namespace lidar_panoptic_clustering
