#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct _cairo;
struct _cairo_surface;

namespace lidar_panoptic_clustering
{
struct Paint
{
  std::uint32_t rgb = 0;  ///< 0x00RRGGBB
  double alpha = 1.0;
};

/// An axis-parallel rectangle [px]; y points down.
struct Box
{
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  bool contains(double px, double py) const { return px >= x && px < right() && py >= y && py < bottom(); }
};

/// A square of `size` pixels around pixel (x, y).
struct Dot
{
  int x, y, size;
  std::uint32_t rgb;
};

struct PixelPoint
{
  double x, y;
};

/// Where a text stands from its anchor; the anchor's height is the middle of a capital letter.
enum class TextAlign
{
  kLeft,
  kCentre,
  kRight
};

struct TextStyle
{
  double size = 16.0;  ///< em [px]
  Paint paint;
  TextAlign align = TextAlign::kLeft;
  bool bold = false;
};

/// An opaque picture to draw on. The one place that knows cairo.
class Canvas
{
public:
  /// Throws std::invalid_argument unless both sides are within 1..32767 px.
  Canvas(int width, int height, std::uint32_t background);
  /// Throws std::runtime_error naming the file.
  static Canvas readPng(const std::string& path);

  int width() const;
  int height() const;
  /// 0x00RRGGBB; the pixel has to lie inside.
  std::uint32_t pixel(int x, int y) const;

  /// Everything until the next call is drawn inside `box` only.
  void clip(const Box& box);
  void unclip();

  /// Without anti-aliasing, in the order given; fast. `box` clips them.
  void dots(const std::vector<Dot>& dots, const Box& box);
  void fill(const Box& box, Paint paint);
  void fill(const std::vector<PixelPoint>& polygon, Paint paint);
  void line(const std::vector<PixelPoint>& points, Paint paint, double width);
  void circle(PixelPoint centre, double radius, Paint paint, double width);
  void text(PixelPoint anchor, const std::string& text, const TextStyle& style);
  /// As text, on a translucent plate that keeps it readable above points.
  void textOnPlate(PixelPoint anchor, const std::string& text, const TextStyle& style, Paint plate);
  /// As text, in smaller letters where it is wider than `room` [px].
  void fittedText(PixelPoint anchor, const std::string& text, TextStyle style, double room);
  double textWidth(const std::string& text, const TextStyle& style);

  /// Writes aside and renames, so that `path` is never half a picture.
  /// Throws std::runtime_error naming the path and the cause.
  void writePng(const std::string& path) const;

private:
  explicit Canvas(_cairo_surface* surface);

  void setPaint(Paint paint);
  void setFont(const TextStyle& style);
  double capHeight();

  std::unique_ptr<_cairo_surface, void (*)(_cairo_surface*)> surface_;
  std::unique_ptr<_cairo, void (*)(_cairo*)> context_;
};
}  // namespace lidar_panoptic_clustering
