#include "drawing/canvas.h"

#include "core/aside_file.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace lidar_panoptic_clustering
{
namespace
{
constexpr int kMaxSide = 32767;  // cairo's limit for image surfaces
constexpr double kFullCircle = 2.0 * 3.14159265358979323846;

cairo_surface_t* newSurface(int width, int height)
{
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    throw std::invalid_argument("picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                " px, expected sides of 1 to " + std::to_string(kMaxSide));
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
}
}  // namespace

Canvas::Canvas(cairo_surface_t* surface)
    : surface_(surface, cairo_surface_destroy), context_(cairo_create(surface), cairo_destroy)
{
  const cairo_status_t status = cairo_status(context_.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot draw: ") + cairo_status_to_string(status));
}

Canvas::Canvas(int width, int height, std::uint32_t background) : Canvas(newSurface(width, height))
{
  setPaint({background});
  cairo_paint(context_.get());
}

Canvas Canvas::readPng(const std::string& path)
{
  cairo_surface_t* surface = cairo_image_surface_create_from_png(path.c_str());
  const cairo_status_t status = cairo_surface_status(surface);
  if (status != CAIRO_STATUS_SUCCESS)
  {
    cairo_surface_destroy(surface);
    throw std::runtime_error("cannot read picture '" + path + "': " + cairo_status_to_string(status));
  }
  return Canvas(surface);
}

int Canvas::width() const
{
  return cairo_image_surface_get_width(surface_.get());
}
int Canvas::height() const
{
  return cairo_image_surface_get_height(surface_.get());
}

std::uint32_t Canvas::pixel(int x, int y) const
{
  cairo_surface_flush(surface_.get());
  const unsigned char* row =
      cairo_image_surface_get_data(surface_.get()) + std::ptrdiff_t{y} * cairo_image_surface_get_stride(surface_.get());
  std::uint32_t value = 0;
  std::memcpy(&value, row + std::ptrdiff_t{x} * 4, sizeof(value));
  return value & 0xFFFFFFU;
}

void Canvas::clip(const Box& box)
{
  unclip();
  cairo_rectangle(context_.get(), box.x, box.y, box.width, box.height);
  cairo_clip(context_.get());
}

void Canvas::unclip()
{
  cairo_reset_clip(context_.get());
}

void Canvas::dots(const std::vector<Dot>& dots, const Box& box)
{
  const int left = std::max(0, static_cast<int>(std::ceil(box.x)));
  const int top = std::max(0, static_cast<int>(std::ceil(box.y)));
  const int right = std::min(width(), static_cast<int>(std::floor(box.right())));
  const int bottom = std::min(height(), static_cast<int>(std::floor(box.bottom())));
  cairo_surface_flush(surface_.get());
  unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface_.get());
  for (const Dot& dot : dots)
  {
    const int x0 = dot.x - dot.size / 2, y0 = dot.y - dot.size / 2;
    const int x_end = std::min(x0 + dot.size, right), y_end = std::min(y0 + dot.size, bottom);
    for (int y = std::max(y0, top); y < y_end; ++y)
      for (int x = std::max(x0, left); x < x_end; ++x)
        std::memcpy(data + y * stride + std::ptrdiff_t{x} * 4, &dot.rgb, sizeof(dot.rgb));
  }
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::fill(const Box& box, Paint paint)
{
  setPaint(paint);
  cairo_rectangle(context_.get(), box.x, box.y, box.width, box.height);
  cairo_fill(context_.get());
}

void Canvas::fill(const std::vector<PixelPoint>& polygon, Paint paint)
{
  setPaint(paint);
  for (const PixelPoint& point : polygon) cairo_line_to(context_.get(), point.x, point.y);
  cairo_close_path(context_.get());
  cairo_fill(context_.get());
}

void Canvas::line(const std::vector<PixelPoint>& points, Paint paint, double width)
{
  setPaint(paint);
  cairo_set_line_width(context_.get(), width);
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  for (const PixelPoint& point : points) cairo_line_to(context_.get(), point.x, point.y);
  cairo_stroke(context_.get());
}

void Canvas::circle(PixelPoint centre, double radius, Paint paint, double width)
{
  setPaint(paint);
  cairo_set_line_width(context_.get(), width);
  cairo_arc(context_.get(), centre.x, centre.y, radius, 0.0, kFullCircle);
  cairo_stroke(context_.get());
}

void Canvas::text(PixelPoint anchor, const std::string& text, const TextStyle& style)
{
  if (text.empty()) return;
  const double width = textWidth(text, style);
  const double shift = style.align == TextAlign::kLeft ? 0.0 : style.align == TextAlign::kCentre ? 0.5 : 1.0;
  setPaint(style.paint);
  cairo_move_to(context_.get(), anchor.x - shift * width, anchor.y + 0.5 * capHeight());
  cairo_show_text(context_.get(), text.c_str());
  cairo_new_path(context_.get());
}

void Canvas::textOnPlate(PixelPoint anchor, const std::string& text, const TextStyle& style, Paint plate)
{
  if (text.empty()) return;
  const double width = textWidth(text, style), pad = 0.3 * style.size;
  const double shift = style.align == TextAlign::kLeft ? 0.0 : style.align == TextAlign::kCentre ? 0.5 : 1.0;
  fill(Box{anchor.x - shift * width - pad, anchor.y - 0.7 * style.size, width + 2.0 * pad, 1.4 * style.size}, plate);
  this->text(anchor, text, style);
}

void Canvas::fittedText(PixelPoint anchor, const std::string& text, TextStyle style, double room)
{
  const double width = textWidth(text, style);
  if (width > room) style.size *= std::max(0.2, room / width);
  this->text(anchor, text, style);
}

double Canvas::textWidth(const std::string& text, const TextStyle& style)
{
  setFont(style);
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::writePng(const std::string& path) const
{
  const auto append = [](void* png, const unsigned char* bytes, unsigned count)
  {
    static_cast<std::string*>(png)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  };
  AsideFile file(path);
  std::string png;
  cairo_status_t status = cairo_status(context_.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_write_to_png_stream(surface_.get(), append, &png);
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error("cannot write picture '" + path + "': " + cairo_status_to_string(status));
  file.save(png);
}

void Canvas::setPaint(Paint paint)
{
  cairo_set_source_rgba(context_.get(), ((paint.rgb >> 16) & 0xFFU) / 255.0, ((paint.rgb >> 8) & 0xFFU) / 255.0,
                        (paint.rgb & 0xFFU) / 255.0, paint.alpha);
}

void Canvas::setFont(const TextStyle& style)
{
  cairo_select_font_face(context_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_.get(), style.size);
}

double Canvas::capHeight()
{
  cairo_text_extents_t extents;
  cairo_text_extents(context_.get(), "H", &extents);
  return -extents.y_bearing;
}
}  // namespace lidar_panoptic_clustering
