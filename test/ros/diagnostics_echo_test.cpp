#include "reporting/diagnostics_echo.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace
{
using Status = diagnostic_msgs::DiagnosticStatus;

diagnostic_msgs::DiagnosticArray said(int level, const std::string& message, const std::string& last_error = "none",
                                      const std::string& name = "birds_eye: scans")
{
  diagnostic_msgs::DiagnosticArray array;
  array.status.resize(2);
  array.status[0].name = "somebody else: temperature";
  array.status[0].level = Status::ERROR;
  array.status[1].name = name;
  array.status[1].level = static_cast<std::int8_t>(level);
  array.status[1].message = message;
  array.status[1].values.resize(1);
  array.status[1].values[0].key = "last error";
  array.status[1].values[0].value = last_error;
  return array;
}

std::vector<std::string> texts(const std::vector<DiagnosticsEcho::Line>& lines)
{
  std::vector<std::string> found;
  for (const auto& line : lines) found.push_back(line.text);
  return found;
}

using Texts = std::vector<std::string>;

TEST(DiagnosticsEcho, TellsEachStateOnceAndTroubleAgainEveryMinute)
{
  DiagnosticsEcho echo({"/birds_eye"}, "/driver");
  EXPECT_EQ(texts(echo.take(said(Status::OK, "idle"), 100.0)), Texts{"/birds_eye: idle"});
  for (double t = 101.0; t < 300.0; ++t) EXPECT_TRUE(echo.take(said(Status::OK, "idle"), t).empty());
  EXPECT_EQ(texts(echo.take(said(Status::WARN, "no input"), 301.0)), Texts{"/birds_eye: no input"});
  EXPECT_TRUE(echo.take(said(Status::WARN, "no input"), 302.0).empty());
  EXPECT_EQ(echo.take(said(Status::WARN, "no input"), 361.0).size(), 1U);
  EXPECT_EQ(texts(echo.take(said(Status::OK, "processing"), 370.0)), Texts{"/birds_eye: processing"});
}

TEST(DiagnosticsEcho, WorseStatesAreToldAtOnceAndOthersEveryFiveSeconds)
{
  DiagnosticsEcho echo({"/birds_eye"}, "/driver");
  std::size_t lines = 0;
  for (int i = 0; i < 100; ++i)  // a text with a number, ten times a second
    lines += echo.take(said(Status::WARN, "found " + std::to_string(i)), 100.0 + 0.1 * i).size();
  EXPECT_EQ(lines, 2U);
  const auto error = echo.take(said(Status::ERROR, "all refused"), 110.0);
  ASSERT_EQ(error.size(), 1U);
  EXPECT_EQ(error[0].level, Status::ERROR);
}

TEST(DiagnosticsEcho, LeavesOutWhatTheNodeletsLogOnTheSameScreen)
{
  DiagnosticsEcho elsewhere({"/birds_eye"}, "/driver"), here({"/birds_eye"}, "");
  const auto refused = said(Status::ERROR, "scans refused: cloud dropped: no x", "cloud dropped: no x");
  EXPECT_EQ(elsewhere.take(refused, 100.0).size(), 1U);
  EXPECT_TRUE(here.take(refused, 100.0).empty());
  const auto failed = said(Status::ERROR, "not loaded: no such table", "none", "birds_eye: load");
  EXPECT_EQ(texts(elsewhere.take(failed, 110.0)), Texts{"/birds_eye: not loaded: no such table"});
  EXPECT_TRUE(here.take(failed, 110.0).empty());
  EXPECT_EQ(here.take(said(Status::WARN, "no input"), 120.0).size(), 1U);
}

TEST(DiagnosticsEcho, TellsWhatIsNotHeardOf)
{
  DiagnosticsEcho echo({"/birds_eye", "/birds_eye_organizer"}, "/driver");
  EXPECT_TRUE(echo.missing(100.0).empty());
  EXPECT_EQ(echo.take(said(Status::OK, "idle"), 110.0).size(), 1U);
  EXPECT_EQ(texts(echo.missing(116.0)),
            Texts{"/birds_eye_organizer: not heard of; does its nodelet manager /driver run?"});
  EXPECT_TRUE(echo.missing(117.0).empty());
  EXPECT_EQ(texts(echo.missing(126.0)), Texts{"/birds_eye: not heard of; does its nodelet manager /driver run?"});
  EXPECT_EQ(texts(echo.take(said(Status::OK, "idle"), 132.0)), Texts{"/birds_eye: idle"}) << "it is back";
}

TEST(DiagnosticsEcho, NothingMoreIsToBeHeardOfWhatWasNotLoaded)
{
  DiagnosticsEcho echo({"/birds_eye"}, "/driver");
  echo.missing(100.0);
  EXPECT_EQ(echo.take(said(Status::ERROR, "not loaded: why", "none", "birds_eye: load"), 101.0).size(), 1U);
  EXPECT_TRUE(echo.missing(150.0).empty());
}
}  // namespace
}  // namespace lidar_panoptic_clustering
