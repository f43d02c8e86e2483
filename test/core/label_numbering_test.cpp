// Streams of a simulated street whose classes are numbered in other ways than their table has it.
#include "lidar_panoptic_clustering/core/label_numbering.h"

#include "scan_fixture.h"
#include "unordered_clouds.h"

#include "lidar_panoptic_clustering/core/class_mapping.h"

#include <gtest/gtest.h>

#include <set>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kMinusOne = 0xFFFFFFFFU;

std::shared_ptr<const ClassTable> tableOf(const std::string& name)
{
  return std::make_shared<const ClassTable>(ClassTable::load(name));
}

/// A few scans of the street with raw ids of SemanticKITTI.
const std::vector<LabelledCloud>& street()
{
  static const std::vector<LabelledCloud> scans = []
  {
    std::vector<LabelledCloud> made;
    for (const std::uint64_t frame : {0, 60, 120, 180}) made.push_back(simulatedScan("os1_64", frame));
    return made;
  }();
  return scans;
}

/// The scan as a network publishes it that numbers its classes by `table`.
LabelledCloud numberedBy(const std::string& table, LabelledCloud scan)
{
  const ClassMapping mapping(*kittiTable(), *tableOf(table));
  for (LabelledPoint& p : scan.points) p.label = mapping(p.label);
  return scan;
}

/// The same with all but some ids left out.
LabelledCloud onlyIds(const std::set<std::uint32_t>& ids, LabelledCloud scan)
{
  for (LabelledPoint& p : scan.points)
    if (ids.count(p.label) == 0) p.label = 0;
  return scan;
}

std::string errorOf(LabelNumbering& numbering, const LabelledCloud& scan, const std::vector<std::uint32_t>& hidden = {})
{
  try
  {
    numbering.check(scan, hidden);
    return "";
  }
  catch (const std::invalid_argument& error)
  {
    return error.what();
  }
}

bool has(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

TEST(LabelNumbering, EachTableTakesItsOwnIds)
{
  for (const std::string& name : ClassTable::shippedNames())
  {
    if (name == "object") continue;
    LabelNumbering numbering(tableOf(name), {true});
    for (const LabelledCloud& scan : street()) EXPECT_EQ(errorOf(numbering, numberedBy(name, scan)), "") << name;
    EXPECT_EQ(numbering.doubt(), "") << name;
  }
  LabelNumbering by_default(kittiTable(), {});
  for (const LabelledCloud& scan : street()) EXPECT_EQ(errorOf(by_default, scan), "");
  EXPECT_EQ(by_default.doubt(), "") << "road and vegetation are 40 and 70 in no other table";
}

/// Every numbering against every table of another: refused in every scan, whatever the first scans show, and the right
/// table is among those named.
TEST(LabelNumbering, OtherNumberingsAreRefusedInEveryScanAndTheirTableIsNamed)
{
  for (const std::string& sent : ClassTable::shippedNames())
    for (const std::string& read : ClassTable::shippedNames())
      for (const bool chosen : {false, true})
      {
        if (sent == read || sent == "object" || read == "object") continue;
        SCOPED_TRACE(sent + " read by " + read);
        LabelNumbering numbering(tableOf(read), {chosen});
        for (const LabelledCloud& scan : street())
        {
          const std::string error = errorOf(numbering, numberedBy(sent, scan));
          EXPECT_NE(error, "") << numbering.doubt();
          if (error.empty()) continue;
          EXPECT_TRUE(has(error, "expected class ids of the table '" + read + "' (parameter label_table")) << error;
          EXPECT_TRUE(has(error, "'" + sent + "'")) << error;
        }
      }
}

/// Training ids that are raw ids too: ground called bicycle, vegetation called motorcycle.
TEST(LabelNumbering, SharedIdsAreToldByWhatTheyLieOn)
{
  const std::set<std::uint32_t> shared = {0, 1, 10, 11, 13, 15, 16, 18};
  LabelNumbering numbering(kittiTable(), {});
  for (const LabelledCloud& scan : street())
  {
    const std::string error = errorOf(numbering, onlyIds(shared, numberedBy("semantic_kitti_training", scan)));
    EXPECT_TRUE(has(error, "as flat as the ground in")) << error;
    EXPECT_TRUE(has(error, "'semantic_kitti_training'")) << error;
  }
  LabelNumbering unchecked(kittiTable(), {false, 0.0, false});
  EXPECT_EQ(errorOf(unchecked, onlyIds(shared, numberedBy("semantic_kitti_training", street()[0]))), "");
  EXPECT_TRUE(has(unchecked.doubt(), "'semantic_kitti_training'")) << unchecked.doubt();
  EXPECT_TRUE(has(unchecked.doubt(), "set label_table")) << unchecked.doubt();
}

/// A scan of `ids` on cells that tell nothing: returns all over the place.
LabelledCloud formless(const std::vector<std::uint32_t>& ids)
{
  LabelledCloud scan = randomScan(3, 8, 64);
  std::size_t i = 0;
  for (LabelledPoint& p : scan.points)
    if (hasReturn(p)) p.label = ids[i++ % ids.size()];
  return scan;
}

TEST(LabelNumbering, AnIdSeenOnceCountsForTheScansAfterIt)
{
  LabelNumbering numbering(kittiTable(), {});
  EXPECT_EQ(errorOf(numbering, formless({1, 10, 15})), "");
  EXPECT_TRUE(has(numbering.doubt(), "(1, 10, 15)")) << numbering.doubt();
  EXPECT_TRUE(has(errorOf(numbering, formless({1, 9, 10})), "9 ("));
  for (int i = 0; i < 30; ++i)
  {
    const std::string error = errorOf(numbering, formless({1, 10, 15}));
    EXPECT_TRUE(has(error, "found that scans before this one had others: 9; the ids so far (1, 9, 10, 15) fit"))
        << error;
  }
}

TEST(LabelNumbering, OneBadScanIsRefusedAloneWhereTheStreamIsCertain)
{
  for (const bool chosen : {false, true})
  {
    LabelNumbering numbering(kittiTable(), {chosen});
    EXPECT_EQ(errorOf(numbering, formless({10, 40})), "");
    EXPECT_TRUE(has(errorOf(numbering, formless({10, 40, 9})), "none of the tables that ship fits the ids so far"));
    EXPECT_EQ(errorOf(numbering, formless({10})), "");
  }
}

TEST(LabelNumbering, WhoChoseATableIsBelievedAgainAfterTenScans)
{
  LabelNumbering numbering(kittiTable(), {true});
  EXPECT_NE(errorOf(numbering, formless({10, 9})), "");
  for (int i = 0; i < 9; ++i) EXPECT_NE(errorOf(numbering, formless({10})), "") << i;
  EXPECT_EQ(errorOf(numbering, formless({10})), "");
}

TEST(LabelNumbering, TheFirstIdThatTheTableLacksIsRefusedUnlessAShareIsAllowed)
{
  LabelledCloud scan = formless({40});
  const auto first = std::find_if(scan.points.begin(), scan.points.end(), hasReturn);
  first->label = 9;
  LabelNumbering strict(kittiTable(), {true}), allowing(kittiTable(), {true, 0.01});
  EXPECT_TRUE(has(errorOf(strict, scan), "found that 1 of ")) << errorOf(strict, scan);
  EXPECT_EQ(errorOf(allowing, scan), "");
  EXPECT_TRUE(has(errorOf(allowing, formless({40, 9})), "9 (")) << "half of them is more than a hundredth";
  EXPECT_EQ(errorOf(strict, formless({0, 40})), "");
  EXPECT_TRUE(has(errorOf(strict, formless({40}), {40, 23}), "23 (1 points)")) << "hidden returns count too";
}

TEST(LabelNumbering, MinusOneIsCalledThat)
{
  LabelNumbering kitti(kittiTable(), {true}), less_one(tableOf("semantic_kitti_training_less_one"), {true});
  const std::string error = errorOf(kitti, formless({kMinusOne, 1, 40}));
  EXPECT_TRUE(has(error, "-1 (")) << error;
  EXPECT_TRUE(has(error, "(-1, 1, 40)")) << error;
  EXPECT_FALSE(has(error, "4294967295")) << error;
  EXPECT_EQ(errorOf(less_one, formless({kMinusOne, 1, 255})), "") << "no class, in this convention";
}

TEST(LabelNumbering, WithoutReturnsNothingIsDecided)
{
  LabelNumbering numbering(kittiTable(), {});
  EXPECT_EQ(errorOf(numbering, LabelledCloud()), "");
  EXPECT_EQ(errorOf(numbering, emptyCloud(4, 16)), "");
  LabelledCloud beyond = emptyCloud(1, 16);
  for (LabelledPoint& p : beyond.points) p.label = 12345;
  EXPECT_EQ(errorOf(numbering, beyond), "") << "of what is no return";
  EXPECT_EQ(numbering.doubt(), "");
}
}  // namespace
}  // namespace lidar_panoptic_clustering
