#include "lidar_panoptic_clustering/drawing/street_picture.h"

#include "drawing/perspective.h"
#include "drawing_fixture.h"

#include <limits>
#include <stdexcept>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kRed = 0xFF0000, kGreen = 0x00FF00, kWhite = 0xFFFFFF;

PanopticPoint point(float x, float y, float z, std::uint32_t instance, std::uint32_t rgb)
{
  PanopticPoint p;
  p.x = x, p.y = y, p.z = z, p.instance = instance, p.rgb = rgb;
  return p;
}

PanopticCloud cloudOf(const std::vector<PanopticPoint>& points)
{
  PanopticCloud cloud;
  for (const PanopticPoint& p : points) cloud.push_back(p);
  return cloud;
}

/// An eye at the origin that looks along x.
StreetPictureOptions lookingAhead()
{
  StreetPictureOptions options;
  options.camera = {0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 90.0};
  options.width_px = 400, options.height_px = 200;
  return options;
}

Box all(const Canvas& picture)
{
  return {0.0, 0.0, double(picture.width()), double(picture.height())};
}
}  // namespace

TEST(Perspective, aPinholeCameraThatStandsUpright)
{
  const Perspective view(lookingAhead());
  EXPECT_DOUBLE_EQ(view.focalLength(), 200.0);  // half the width over the tangent of half of 90 degrees
  const auto left_above = view.toPixel({10.0, 5.0, 2.0});
  ASSERT_TRUE(left_above);
  EXPECT_NEAR(left_above->x, 200.0 - 100.0, 1e-9);
  EXPECT_NEAR(left_above->y, 100.0 - 40.0, 1e-9);
  EXPECT_DOUBLE_EQ(view.depth({10.0, 5.0, 2.0}), 10.0);
  EXPECT_FALSE(view.toPixel({-10.0, 0.0, 0.0})) << "behind the eye";
  EXPECT_FALSE(view.toPixel({0.4, 0.0, 0.0})) << "nearer than half a metre";
}

TEST_F(Drawing, nearPointsHideFarOnesInAStreetPicture)
{
  const PanopticCloud cloud = cloudOf({point(5.0F, 0.0F, 0.0F, 1, kRed), point(20.0F, 0.0F, 0.0F, 2, kGreen),
                                       point(20.0F, 10.0F, 0.0F, 3, kGreen), point(0.0F, 0.0F, 0.0F, 4, kWhite),
                                       point(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 5, kWhite)});
  drawStreetPicture(cloud, {}, file("street.png"), lookingAhead());
  const Canvas picture = Canvas::readPng(file("street.png"));
  EXPECT_EQ(picture.width(), 400);
  EXPECT_EQ(picture.height(), 200);
  EXPECT_EQ(picture.pixel(200, 100), kRed);
  EXPECT_EQ(countPixels(picture, {98.0, 98.0, 4.0, 4.0}, kGreen), 1U);
  EXPECT_EQ(countPixels(picture, all(picture), kGreen), 1U) << "the other one is hidden";
  EXPECT_EQ(countPixels(picture, all(picture), kWhite), 0U) << "no return";
  EXPECT_EQ(fileCount(), 1U);
}

TEST_F(Drawing, boxesOfAStreetPictureBearTheirNames)
{
  NamedBox box;
  box.x = 10.0F, box.length = 4.0F, box.width = 2.0F, box.height = 2.0F, box.rgb = kGreen;
  const auto whitePixels = [&](const std::vector<NamedBox>& boxes, const StreetPictureOptions& options)
  {
    drawStreetPicture(PanopticCloud(), boxes, file("street.png"), options);
    const Canvas picture = Canvas::readPng(file("street.png"));
    return countPixels(picture, all(picture), kWhite);
  };
  StreetPictureOptions options = lookingAhead();
  options.width_px = 1600, options.height_px = 800;
  EXPECT_EQ(whitePixels({box}, options), 0U);
  const Canvas unnamed = Canvas::readPng(file("street.png"));
  // the near face: 8 m ahead, 1 m to the left; focal length 800 px
  const std::uint32_t edge = unnamed.pixel(800 - 100, 400);
  EXPECT_GT((edge >> 8) & 0xFFU, 0x60U) << std::hex << edge;

  box.text = "car 1";
  const std::size_t one = whitePixels({box}, options);
  EXPECT_GT(one, 50U);
  NamedBox behind = box;
  behind.x = 12.0F;
  EXPECT_EQ(whitePixels({box, behind}, options), one) << "the nearer box keeps its text, the other's would cover it";
  behind.y = 5.0F;
  EXPECT_GT(whitePixels({box, behind}, options), one + one / 2);
  options.farthest_named_m = 11.0;
  EXPECT_EQ(whitePixels({box, behind}, options), one);
  box.x = -10.0F;
  EXPECT_EQ(whitePixels({box}, options), 0U) << "behind the eye";
}

TEST_F(Drawing, wrongStreetPicturesAreRefused)
{
  const auto draw = [this](const StreetPictureOptions& options)
  { drawStreetPicture(PanopticCloud(), {}, file("never.png"), options); };
  StreetPictureOptions options = lookingAhead();
  options.width_px = 159;
  EXPECT_THROW(draw(options), std::invalid_argument);
  options = lookingAhead();
  options.camera.field_of_view_deg = 151.0;
  EXPECT_THROW(draw(options), std::invalid_argument);
  options = lookingAhead();
  options.camera = {1.0, 2.0, 9.0, 1.0, 2.0, 0.0, 60.0};
  EXPECT_THROW(draw(options), std::invalid_argument) << "straight down";
  EXPECT_EQ(fileCount(), 0U);
  EXPECT_THROW(drawStreetPicture(PanopticCloud(), {}, file("no/such.png"), lookingAhead()), std::runtime_error);
}
}  // namespace lidar_panoptic_clustering
