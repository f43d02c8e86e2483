// The pictures of the documentation show what they say.
#include "tools/support/step_figures.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
namespace fs = std::filesystem;

/// The instances, of five points and more, that the points of each true object got.
std::map<std::uint32_t, std::set<std::uint32_t>> instancesOfObjects(const FigureScan& scan)
{
  const PanopticCloud scene = stepScene();
  std::map<std::uint32_t, std::map<std::uint32_t, int>> counts;
  for (std::size_t i = 0; i < scene.size(); ++i)
    if (scene.points[i].instance > 0) ++counts[scene.points[i].instance][scan.cloud.points[i].instance];
  std::map<std::uint32_t, std::set<std::uint32_t>> instances;
  for (const auto& [object, by_instance] : counts)
    for (const auto& [instance, count] : by_instance)
      if (count >= 5) instances[object].insert(instance);
  return instances;
}

auto afterSteps(bool bridge, bool split, bool merge)
{
  return instancesOfObjects(detail::clusterScene(withoutInstances(stepScene()), "birds_eye",
                                                 detail::refinementSteps(bridge, split, merge, false)));
}

std::set<std::uint32_t> labelsOfMislabelledCar(bool vote)
{
  const PanopticCloud scene = stepScene();
  const FigureScan scan =
      detail::clusterScene(withoutInstances(scene), "birds_eye", detail::refinementSteps(true, true, true, vote));
  std::set<std::uint32_t> labels;
  for (std::size_t i = 0; i < scene.size(); ++i)
    if (scene.points[i].instance == kMislabelledCar) labels.insert(scan.cloud.points[i].label);
  return labels;
}
}  // namespace

TEST(StepFigures, EachStepMendsOneObjectOfTheScene)
{
  auto found = afterSteps(false, false, false);
  EXPECT_EQ(found.size(), 6U);
  EXPECT_EQ(found[kMislabelledCar].size(), 2U);
  EXPECT_EQ(found[kFirstParkedCar], found[kSecondParkedCar]);
  EXPECT_EQ(found[kHiddenCar].size(), 2U);

  found = afterSteps(true, false, false);
  EXPECT_EQ(found[kMislabelledCar].size(), 1U) << "bridge";
  EXPECT_NE(found[kMislabelledCar], found[kPersonBesideIt]);
  EXPECT_EQ(found[kFirstParkedCar], found[kSecondParkedCar]);

  found = afterSteps(true, true, false);
  EXPECT_NE(found[kFirstParkedCar], found[kSecondParkedCar]) << "split";
  EXPECT_EQ(found[kHiddenCar].size(), 2U);

  found = afterSteps(true, true, true);
  EXPECT_EQ(found[kHiddenCar].size(), 1U) << "merge";
  std::set<std::set<std::uint32_t>> all;
  for (const auto& [object, instances] : found) all.insert(instances);
  EXPECT_EQ(all.size(), 6U) << "six objects";
}

TEST(StepFigures, TheVoteGivesTheMislabelledCarOneClass)
{
  EXPECT_EQ(labelsOfMislabelledCar(false), (std::set<std::uint32_t>{10, 18}));
  EXPECT_EQ(labelsOfMislabelledCar(true), std::set<std::uint32_t>{10});
}

TEST(StepFigures, TheProgramDrawsAllPicturesOfTheDocumentation)
{
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "panoptic_figures";
  if (!fs::exists(program)) GTEST_SKIP() << program << " is not built beside this test";
  std::string pattern = (fs::temp_directory_path() / "step_figures_XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const fs::path folder = fs::path(pattern) / "made";
  const int status = std::system(("'" + program.string() + "' --output '" + folder.string() + "'").c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  std::set<std::string> drawn, documented;
  for (const auto& entry : fs::directory_iterator(folder)) drawn.insert(entry.path().filename());
  for (const auto& entry : fs::directory_iterator("doc/pictures")) documented.insert(entry.path().filename());
  EXPECT_EQ(drawn, documented);
  fs::remove_all(pattern);
}
}  // namespace lidar_panoptic_clustering
