#include "lidar_panoptic_clustering/drawing/street_picture.h"

#include "drawing/birds_eye_view.h"
#include "drawing/perspective.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr std::uint32_t kBackground = 0x0B0E14, kWhite = 0xFFFFFF;
constexpr double kThingM = 0.075, kStuffM = 0.05;  // a point's side, as if it were a patch of the surface

/// The class colour in the shade, so that the instances stand out.
std::uint32_t shaded(std::uint32_t rgb)
{
  const std::uint32_t r = (rgb >> 16) & 0xFFU, g = (rgb >> 8) & 0xFFU, b = rgb & 0xFFU, grey = (r + g + b) / 3U;
  const auto channel = [grey](std::uint32_t value) { return 30U + (4U * grey + value) / 11U; };
  return channel(r) << 16 | channel(g) << 8 | channel(b);
}

struct SeenPoint
{
  double depth;
  Dot dot;
};

void drawPoints(Canvas& canvas, const Perspective& view, const PanopticCloud& cloud, double scale)
{
  const Box picture{0.0, 0.0, double(canvas.width()), double(canvas.height())};
  std::vector<SeenPoint> seen;
  for (const PanopticPoint& point : cloud)
  {
    if (!isReturn(point)) continue;
    const Eigen::Vector3d place = point.getVector3fMap().cast<double>();
    const auto pixel = view.toPixel(place);
    if (!pixel || !picture.contains(pixel->x, pixel->y)) continue;
    const bool thing = point.instance > 0;
    const double depth = view.depth(place);
    const double size = std::clamp((thing ? kThingM : kStuffM) * view.focalLength() / depth,
                                   (thing ? 2.0 : 1.0) * scale, (thing ? 5.0 : 2.5) * scale);
    seen.push_back({depth,
                    {static_cast<int>(pixel->x), static_cast<int>(pixel->y),
                     std::max(1, static_cast<int>(std::lround(size))), thing ? point.rgb : shaded(point.rgb)}});
  }
  std::sort(seen.begin(), seen.end(), [](const SeenPoint& a, const SeenPoint& b) { return a.depth > b.depth; });
  std::vector<Dot> dots;
  dots.reserve(seen.size());
  for (const SeenPoint& point : seen) dots.push_back(point.dot);
  canvas.dots(dots, picture);
}

/// The corner with the signs of bits 0 (length), 1 (width) and 2 (height).
Eigen::Vector3d corner(const NamedBox& box, unsigned bits)
{
  const double x = (bits & 1U ? 0.5 : -0.5) * box.length, y = (bits & 2U ? 0.5 : -0.5) * box.width;
  const double c = std::cos(box.yaw), s = std::sin(box.yaw);
  return {box.x + c * x - s * y, box.y + s * x + c * y, box.z + (bits & 4U ? 0.5 : -0.5) * box.height};
}

/// The box's corners; nothing where one of them is not in front of the eye.
std::optional<std::array<PixelPoint, 8>> cornersOf(const Perspective& view, const NamedBox& box)
{
  std::array<PixelPoint, 8> corners{};
  for (unsigned bits = 0; bits < 8; ++bits)
  {
    const auto pixel = view.toPixel(corner(box, bits));
    if (!pixel) return std::nullopt;
    corners[bits] = *pixel;
  }
  return corners;
}

void drawBox(Canvas& canvas, const std::array<PixelPoint, 8>& at, std::uint32_t rgb, double scale)
{
  canvas.fill({at[0], at[1], at[3], at[2]}, {rgb, 0.16});
  for (const auto& face : {std::array{0, 1, 3, 2}, std::array{4, 5, 7, 6}})
    canvas.line({at[face[0]], at[face[1]], at[face[2]], at[face[3]], at[face[0]]}, {rgb, 0.85}, 1.5 * scale);
  for (unsigned foot = 0; foot < 4; ++foot) canvas.line({at[foot], at[foot + 4]}, {rgb, 0.85}, 1.5 * scale);
}

bool overlap(const Box& a, const Box& b)
{
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

/// Texts placed so far, nearest boxes first.
class Labels
{
public:
  Labels(Canvas& canvas, double scale) : canvas_(canvas), style_{23.0 * scale, {kWhite}, TextAlign::kCentre, true} {}

  void draw(const std::array<PixelPoint, 8>& at, const NamedBox& box)
  {
    PixelPoint anchor{0.0, at[4].y};
    for (unsigned bits = 4; bits < 8; ++bits) anchor.x += 0.25 * at[bits].x, anchor.y = std::min(anchor.y, at[bits].y);
    anchor.y -= 0.9 * style_.size;
    const double width = canvas_.textWidth(box.text, style_) + style_.size;
    const Box plate{anchor.x - 0.5 * width, anchor.y - 0.75 * style_.size, width, 1.5 * style_.size};
    const Box picture{0.0, 0.0, double(canvas_.width()), double(canvas_.height())};
    if (!picture.contains(plate.x, plate.y) || !picture.contains(plate.right(), plate.bottom())) return;
    for (const Box& other : taken_)
      if (overlap(plate, other)) return;
    taken_.push_back(plate);
    canvas_.fill(plate, {kBackground, 0.8});
    canvas_.fill(Box{plate.x, plate.bottom() - 0.14 * style_.size, width, 0.14 * style_.size}, {box.rgb});
    canvas_.text(anchor, box.text, style_);
  }

private:
  Canvas& canvas_;
  TextStyle style_;
  std::vector<Box> taken_;
};
}  // namespace

void drawStreetPicture(const PanopticCloud& cloud, const std::vector<NamedBox>& boxes, const std::string& png_path,
                       const StreetPictureOptions& options)
{
  const Perspective view(options);
  const double scale = options.width_px / 1600.0;
  Canvas canvas(options.width_px, options.height_px, kBackground);
  drawPoints(canvas, view, cloud, scale);

  std::vector<const NamedBox*> far_to_near;
  for (const NamedBox& box : boxes) far_to_near.push_back(&box);
  const auto depth = [&view](const NamedBox* box) { return view.depth({box->x, box->y, box->z}); };
  std::stable_sort(far_to_near.begin(), far_to_near.end(),
                   [&](const NamedBox* a, const NamedBox* b) { return depth(a) > depth(b); });
  for (const NamedBox* box : far_to_near)
    if (const auto corners = cornersOf(view, *box)) drawBox(canvas, *corners, box->rgb, scale);
  Labels labels(canvas, scale);
  for (auto it = far_to_near.rbegin(); it != far_to_near.rend(); ++it)
    if (const auto corners = cornersOf(view, **it); corners && !(*it)->text.empty())
      if (depth(*it) <= options.farthest_named_m) labels.draw(*corners, **it);
  canvas.writePng(png_path);
}
}  // namespace lidar_panoptic_clustering
