#include "drawing/scan_figure_layout.h"
#include "drawing_fixture.h"
#include "lidar_panoptic_clustering/drawing/scan_figure.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kRed = 0xFF0000, kGreen = 0x00FF00;

PanopticPoint point(float x, float y, float z, std::uint32_t instance, std::uint32_t rgb)
{
  PanopticPoint p;
  p.x = x, p.y = y, p.z = z, p.instance = instance, p.rgb = rgb;
  return p;
}

/// Every pixel without a return.
PanopticCloud blank(std::uint32_t height, std::uint32_t width)
{
  PanopticCloud cloud;
  cloud.height = height, cloud.width = width;
  cloud.points.assign(std::size_t{height} * width, point(kNaN, kNaN, kNaN, 0, 0));
  return cloud;
}

}  // namespace

TEST_F(Drawing, objectsAppearAtTheirPlaceInTheirColour)
{
  PanopticCloud cloud = blank(4, 8);
  cloud.at(2, 1) = point(30.0F, 10.0F, 1.0F, 1, kRed);
  cloud.at(6, 2) = point(-20.0F, -8.0F, -1.0F, 2, kGreen);
  cloud.at(0, 0) = point(5.0F, 5.0F, 1.5F, 0, 0xFFFFFF);
  const std::vector<ScanPanel> panels{{"one", &cloud, {}, ""}};
  ScanFigureOptions options;
  options.panel_width_px = 640;
  drawScanFigure(panels, file("scan.png"), options);

  const Canvas picture = Canvas::readPng(file("scan.png"));
  const ScanFigureLayout layout = layOut(panels, options);
  EXPECT_EQ(picture.width(), layout.width);
  EXPECT_EQ(picture.height(), layout.height);
  EXPECT_EQ(fileCount(), 1U) << "nothing is left aside";

  const BirdsEyeView& view = layout.panels[0].birds_eye_view;
  const auto colorAt = [&](double x, double y)
  {
    const PixelPoint at = view.toPixel(x, y);
    return picture.pixel(static_cast<int>(at.x), static_cast<int>(at.y));
  };
  EXPECT_EQ(colorAt(30.0, 10.0), kRed);
  EXPECT_EQ(colorAt(-20.0, -8.0), kGreen);
  EXPECT_LE(countPixels(picture, view.box, kRed), 9U);
  EXPECT_GT(view.toPixel(30.0, 0.0).x, view.toPixel(-20.0, 0.0).x) << "x points right";
  EXPECT_LT(view.toPixel(0.0, 10.0).y, view.toPixel(0.0, -8.0).y) << "y points up";

  // a pixel of the range image covers a fraction of 4 rows and 8 columns
  const Box& range = layout.panels[0].range_picture;
  const auto rangeColor = [&](double column, double row)
  {
    return picture.pixel(static_cast<int>(range.x + (column + 0.5) / 8.0 * range.width),
                         static_cast<int>(range.y + (row + 0.5) / 4.0 * range.height));
  };
  EXPECT_EQ(rangeColor(2, 1), kRed);
  EXPECT_EQ(rangeColor(6, 2), kGreen);
  EXPECT_EQ(countPixels(picture, range, kRed), static_cast<std::size_t>(range.width * range.height) / 32U);
  const std::uint32_t stuff = rangeColor(0, 0);
  EXPECT_EQ(stuff >> 16, stuff & 0xFFU) << "grey";
  EXPECT_NE(stuff, rangeColor(4, 3)) << "no return";
}

TEST_F(Drawing, highestBeamStandsOnTopWhateverTheRingOrder)
{
  PanopticCloud cloud = blank(2, 2);
  cloud.at(0, 0) = point(10.0F, 0.0F, -2.0F, 1, kRed);
  cloud.at(1, 1) = point(10.0F, 0.0F, 2.0F, 2, kGreen);
  const std::vector<ScanPanel> panels{{"", &cloud, {}, ""}};
  drawScanFigure(panels, file("scan.png"));
  const Canvas picture = Canvas::readPng(file("scan.png"));
  const Box range = layOut(panels, {}).panels[0].range_picture;
  EXPECT_EQ(picture.pixel(static_cast<int>(range.x) + 1, static_cast<int>(range.bottom()) - 2), kRed);
  EXPECT_EQ(picture.pixel(static_cast<int>(range.right()) - 2, static_cast<int>(range.y) + 1), kGreen);
}

TEST_F(Drawing, rangeImageKeepsNarrowObjectsWhenItHasMoreColumnsThanThePicture)
{
  PanopticCloud cloud = blank(4, 3200);
  for (PanopticPoint& p : cloud) p = point(3.0F, 0.0F, 0.0F, 0, 0x808080);
  cloud.at(1601, 2) = point(20.0F, 0.0F, 0.0F, 1, kRed);  // farther than the stuff beside it
  const std::vector<ScanPanel> panels{{"", &cloud, {}, ""}};
  ScanFigureOptions options;
  options.panel_width_px = 320;
  drawScanFigure(panels, file("scan.png"), options);
  const Box range = layOut(panels, options).panels[0].range_picture;
  EXPECT_EQ(countPixels(Canvas::readPng(file("scan.png")), range, kRed), static_cast<std::size_t>(range.height) / 4U);
}

TEST_F(Drawing, emptyAndInvalidCloudsStillGiveAPicture)
{
  const PanopticCloud empty, no_return = blank(4, 8);
  PanopticCloud odd = blank(1, 3);
  odd.points[0] = point(0.0F, 0.0F, 0.0F, 1, kRed);
  odd.points[1] = point(3e38F, -3e38F, 3e38F, 2, kRed);
  odd.points[2] = point(std::numeric_limits<float>::infinity(), 0.0F, 0.0F, 3, kRed);
  const Mark nowhere{kNaN, 0.0F, 2.0F, kRed, "nowhere"};
  const std::vector<ScanPanel> panels{
      {"empty", &empty, {nowhere}, ""}, {"NaN", &no_return, {}, ""}, {"odd", &odd, {}, ""}};
  drawScanFigure(panels, file("scan.png"));
  const Canvas picture = Canvas::readPng(file("scan.png"));
  EXPECT_EQ(picture.width(), 3 * 1280 + 4 * 24);
  EXPECT_EQ(countPixels(picture, {0.0, 0.0, double(picture.width()), double(picture.height())}, kRed), 0U);

  const ViewWindow window = viewWindow({{"empty", &empty, {}, ""}});
  EXPECT_EQ(window.min_x, -50.0);
  EXPECT_EQ(window.max_x, 50.0);
}

TEST_F(Drawing, windowHoldsTheMiddleOfTheObjectsAndTheSensor)
{
  PanopticCloud cloud = blank(1, 1002);
  for (std::size_t i = 0; i < 1000; ++i)
    cloud.points[i] = point(10.0F + 0.05F * static_cast<float>(i), 0.0F, 0.0F, 1, kRed);  // 10 .. 59.95 m
  cloud.points[1000] = point(78.0F, 70.0F, 0.0F, 1, kRed);
  cloud.points[1001] = point(-70.0F, -70.0F, 0.0F, 0, 0);
  const ViewWindow window = viewWindow({{"", &cloud, {}, ""}});
  EXPECT_LT(window.min_x, 0.0);
  EXPECT_GT(window.min_x, -10.0);
  EXPECT_GT(window.max_x, 59.0);
  EXPECT_LT(window.max_x, 70.0);
  EXPECT_NEAR(window.height(), 0.45 * window.width(), 1e-9);
}

TEST_F(Drawing, marksStandAroundTheirPlace)
{
  const PanopticCloud cloud = blank(2, 2);
  const std::vector<ScanPanel> panels{{"", &cloud, {{20.0F, 5.0F, 4.0F, kGreen, "split 2"}}, ""}};
  drawScanFigure(panels, file("scan.png"));
  const Canvas picture = Canvas::readPng(file("scan.png"));
  const BirdsEyeView view = layOut(panels, {}).panels[0].birds_eye_view;
  const PixelPoint left = view.toPixel(16.0, 5.0);
  EXPECT_EQ(picture.pixel(static_cast<int>(left.x), static_cast<int>(left.y)), kGreen);
}

TEST_F(Drawing, boxesStandAroundTheirObjectsFromAbove)
{
  const PanopticCloud cloud = blank(2, 2);
  NamedBox box;
  box.x = 20.0F, box.y = 5.0F, box.length = 8.0F, box.width = 4.0F, box.yaw = 1.5707963F, box.rgb = kGreen;
  ScanPanel panel{"", &cloud, {}, "", {box}};
  ScanFigureOptions options;
  options.window = ViewWindow{0.0, 40.0, -10.0, 15.0};
  drawScanFigure({panel}, file("scan.png"), options);
  const Canvas picture = Canvas::readPng(file("scan.png"));
  const BirdsEyeView view = layOut({panel}, options).panels[0].birds_eye_view;
  const auto colorAt = [&](double x, double y)
  {
    const PixelPoint at = view.toPixel(x, y);
    return picture.pixel(static_cast<int>(at.x), static_cast<int>(at.y));
  };
  EXPECT_EQ(colorAt(18.0, 2.5), kGreen) << "a long side, turned to y";
  EXPECT_EQ(colorAt(21.0, 9.0), kGreen) << "a short side";
  EXPECT_NE(colorAt(20.0, 5.0), kGreen) << "the middle is open";
  EXPECT_EQ(view.toPixel(0.0, 15.0).x, view.box.x) << "the window is the one of the options";
  EXPECT_EQ(view.toPixel(40.0, 15.0).y, view.box.y);

  const std::size_t without_text = countPixels(picture, view.box, 0xFFFFFF);
  panel.boxes[0].text = "car 1";
  drawScanFigure({panel}, file("scan.png"), options);
  EXPECT_GT(countPixels(Canvas::readPng(file("scan.png")), view.box, 0xFFFFFF), without_text + 20);
}

TEST_F(Drawing, rangeImagesAndCountsCanBeLeftOut)
{
  const PanopticCloud cloud = blank(4, 8);
  const std::vector<ScanPanel> panels{{"", &cloud, {}, ""}};
  ScanFigureOptions options;
  const int with = layOut(panels, options).height;
  options.range_images = false;
  EXPECT_EQ(layOut(panels, options).panels[0].range_picture.height, 0.0);
  EXPECT_LT(layOut(panels, options).height, with);

  drawScanFigure(panels, file("counted.png"), options);
  options.counts = false;
  drawScanFigure(panels, file("plain.png"), options);
  Box title = layOut(panels, options).panels[0].title;
  title.height -= 1.0;  // the view's frame
  constexpr std::uint32_t kPaper = 0x161B22;
  const auto paper = [&](const char* name) { return countPixels(Canvas::readPng(file(name)), title, kPaper); };
  EXPECT_LT(paper("counted.png"), paper("plain.png"));
  EXPECT_EQ(paper("plain.png"), static_cast<std::size_t>(title.width * title.height)) << "nothing is written";
}

TEST_F(Drawing, wrongScanFiguresAreRefused)
{
  PanopticCloud cloud = blank(2, 3);
  const auto draw = [this](const std::vector<ScanPanel>& panels, int width_px = 1280)
  {
    ScanFigureOptions options;
    options.panel_width_px = width_px;
    drawScanFigure(panels, file("never.png"), options);
  };
  EXPECT_THROW(draw({}), std::invalid_argument);
  EXPECT_THROW(draw({{"missing", nullptr, {}, ""}}), std::invalid_argument);
  EXPECT_THROW(draw({{"", &cloud, {}, ""}}, 319), std::invalid_argument);
  EXPECT_THROW(draw(std::vector<ScanPanel>(40, {"", &cloud, {}, ""}), 8192), std::invalid_argument);
  ScanFigureOptions inside_out;
  inside_out.window = ViewWindow{5.0, -5.0, -5.0, 5.0};
  EXPECT_THROW(drawScanFigure({{"", &cloud, {}, ""}}, file("never.png"), inside_out), std::invalid_argument);
  cloud.width = 4;
  EXPECT_THROW(draw({{"", &cloud, {}, ""}}), std::invalid_argument);
  EXPECT_EQ(fileCount(), 0U);
}

TEST_F(Drawing, unwritablePathIsNamed)
{
  const PanopticCloud cloud = blank(2, 2);
  const auto draw = [&cloud](const std::string& path) { drawScanFigure({{"", &cloud, {}, ""}}, path); };
  const std::string missing = file("no/such/folder.png");
  EXPECT_THROW(draw(missing), std::runtime_error);
  EXPECT_NE(messageOf([&] { draw(missing); }).find(missing), std::string::npos);

  // a folder in the file's place: the picture is written aside, and that is cleared away
  std::filesystem::create_directories(folder_ / "taken.png" / "by_a_folder");
  EXPECT_NE(messageOf([&] { draw(file("taken.png")); }).find(file("taken.png")), std::string::npos);
  EXPECT_EQ(fileCount(), 1U);
}

TEST_F(Drawing, notAPictureIsNamed)
{
  std::ofstream(file("text.png")) << "not a picture";
  EXPECT_NE(messageOf([&] { Canvas::readPng(file("text.png")); }).find(file("text.png")), std::string::npos);
}
}  // namespace lidar_panoptic_clustering
