// Numbers, texts and files as they come from outside, in any locale.
#include "core/plain_numbers.h"

#include "core/aside_file.h"
#include "core/printable.h"
#include "core/system_error.h"
#include "lidar_panoptic_clustering/core/class_table.h"
#include "lidar_panoptic_clustering/core/parameters.h"
#include "lidar_panoptic_clustering/evaluation/benchmark_report.h"
#include "lidar_panoptic_clustering/evaluation/object_recall.h"
#include "lidar_panoptic_clustering/projection/sensor_model.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <locale>

namespace lidar_panoptic_clustering
{
namespace
{
namespace fs = std::filesystem;

/// Writes 1234.5 as 1.234,5.
struct Comma : std::numpunct<char>
{
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// A process with a decimal comma: in streams, and in printf where the system knows such a locale.
class InALocaleWithCommas : public testing::Test
{
protected:
  InALocaleWithCommas()
  {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8"})
      if (std::setlocale(LC_NUMERIC, name) != nullptr) break;
    before_ = std::locale::global(std::locale(std::locale::classic(), new Comma));
  }
  ~InALocaleWithCommas() override
  {
    std::locale::global(before_);
    std::setlocale(LC_NUMERIC, "C");
  }

private:
  std::locale before_;
};

TEST_F(InALocaleWithCommas, NumbersAreWrittenAndReadWithAPoint)
{
  EXPECT_EQ(fixedText(1234567.891, 2), "1234567.89");
  EXPECT_EQ(shortText(0.1), "0.1");
  EXPECT_EQ(shortText(0.1, 17), "0.10000000000000001");
  EXPECT_EQ(parseNumber("1234.5"), 1234.5);
  EXPECT_EQ(parseNumber("-1e-3"), -0.001);
  for (const char* text : {"", "1,5", "1.234,5", "nan", "inf", "1e999", "0x10", "1 ", " 1", "1.5m"})
    EXPECT_FALSE(parseNumber(text)) << text;
}

TEST_F(InALocaleWithCommas, TablesSensorsAndParametersAreTheSame)
{
  const ClassTable table = ClassTable::load("semantic_kitti");
  EXPECT_EQ(table[table.findByName("car")].link_distance_m, 0.8F);
  EXPECT_EQ(SensorModel::load("vlp16").columns, 1808U);
  const SensorModel model = SensorModel::parse("elevations_deg: [1.5, 0.5]\ncolumns: 1800", "s");
  EXPECT_EQ(model.columns, 1800U);
  EXPECT_NEAR(model.elevations_rad[0], 1.5 * 3.14159265 / 180, 1e-6);
  EXPECT_EQ(detail::toDouble("p", std::string("0.25"), 0.0, 1.0), 0.25);
  EXPECT_EQ(parameterText(0.25), "0.25");
  EXPECT_EQ(parameterText(12345), "12345");
  try
  {
    detail::toDouble("p", 1234.5, 0.25, 1000.0);
    ADD_FAILURE();
  }
  catch (const std::invalid_argument& error)
  {
    EXPECT_STREQ(error.what(), "parameter 'p': expected a number from 0.25 to 1000, got 1234.5");
  }
}

TEST_F(InALocaleWithCommas, ReportsAreTheSame)
{
  const auto table = std::make_shared<const ClassTable>(ClassTable::load("semantic_kitti"));
  BenchmarkReport report("net", {"depth"}, table);
  report.rows[0].times = {{"08/000000", 123456, 1234, 1.25, 2.5}};
  const std::uint32_t labels[] = {7U << 16U | 10U, 7U << 16U | 10U, 40};
  report.rows[0].evaluation.quality.addScan(labels, labels, 3);
  const std::string json = report.toJsonText();
  EXPECT_NE(json.find("\"cluster_ms\": 1.25"), std::string::npos) << json;
  EXPECT_NE(json.find("\"points\": 123456"), std::string::npos) << json;
  EXPECT_EQ(BenchmarkReport::fromJsonText(json, "r", table).toJsonText(), json);
  const std::string text = formatBenchmark(report);
  EXPECT_NE(text.find("1.25"), std::string::npos) << text;
  EXPECT_EQ(text.find("1,25"), std::string::npos) << text;
  EXPECT_NE(formatReport(report.rows[0].evaluation).find("100.0"), std::string::npos);
  const std::string recall = formatObjectRecall(ObjectRecall(table));
  EXPECT_NE(recall.find("Ground: precision 0.0, recall 0.0"), std::string::npos) << recall;
  std::string line = "a ";
  appendText(line, "%.1f", 1234.5);
  EXPECT_EQ(line, "a 1234.5");
}

TEST(Printable, ControlCharactersAreShown)
{
  EXPECT_EQ(printable("plain caf\xC3\xA9\n\ttext"), "plain caf\xC3\xA9\n\ttext");
  EXPECT_EQ(printable("a\x1b[2Jb\r\x7f"), "a\\x1b[2Jb\\x0d\\x7f");
  EXPECT_EQ(printable("a\nb\tc", false), "a\\x0ab\\x09c");
  EXPECT_EQ(printable("\xC2\x9B"
                      "2J\xC2\xA0"),
            "\\x9b2J\xC2\xA0");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
}

TEST(SystemError, HasTheSystemsText)
{
  EXPECT_EQ(systemError(ENOENT), "No such file or directory");
  EXPECT_NE(systemError(123456), "");
}

class AsideFileTest : public testing::Test
{
protected:
  AsideFileTest()
  {
    std::string pattern = (fs::temp_directory_path() / "aside_file_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~AsideFileTest() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& path)
  {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t files() const
  {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(AsideFileTest, IsThereWholeOrNotAtAll)
{
  const fs::path path = folder_ / "f";
  {
    AsideFile one(path.string()), two(path.string()), never(path.string());
    EXPECT_FALSE(fs::exists(path));
    one.save("one");
    EXPECT_EQ(read(path), "one");
    two.write("t", 1), two.save("wo");
    EXPECT_FALSE(AsideFile(path.string()).saveIfNone("three"));
  }
  EXPECT_EQ(read(path), "two");
  EXPECT_EQ(files(), 1U);
  EXPECT_TRUE(AsideFile((folder_ / "g").string()).saveIfNone("new"));
  EXPECT_EQ(read(folder_ / "g"), "new");
  EXPECT_EQ(files(), 2U);
}

TEST_F(AsideFileTest, AKilledProcessLeavesNothing)
{
  const int nameless = ::open(folder_.c_str(), O_WRONLY | O_TMPFILE, 0600);
  if (nameless < 0) GTEST_SKIP() << "the file system of " << folder_ << " has no files without a name";
  ::close(nameless);
  const pid_t child = ::fork();
  if (child == 0)
  {
    AsideFile begun((folder_ / "f").string());
    begun.write("half", 4);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(files(), 0U);
}

TEST_F(AsideFileTest, SaysWhyItCannotBeWritten)
{
  const std::string path = (folder_ / "none" / "f").string();
  try
  {
    AsideFile file(path);
    FAIL();
  }
  catch (const std::runtime_error& error)
  {
    EXPECT_EQ(error.what(), "cannot write " + path + ": No such file or directory");
  }
}

TEST_F(AsideFileTest, FollowsNoLinkLaidInItsWay)
{
  std::ofstream(folder_ / "treasure") << "gold";
  const fs::path path = folder_ / "f";
  for (int i = 0; i < 300; ++i)
    fs::create_symlink(folder_ / "treasure",
                       path.string() + "." + std::to_string(getpid()) + "-" + std::to_string(i) + ".part");
  AsideFile(path.string()).save("new");
  EXPECT_EQ(read(folder_ / "treasure"), "gold");
  EXPECT_EQ(read(path), "new");
  fs::create_symlink(folder_ / "treasure", folder_ / "link");
  AsideFile((folder_ / "link").string()).save("new");
  EXPECT_EQ(read(folder_ / "treasure"), "gold");
}
}  // namespace
}  // namespace lidar_panoptic_clustering
