#include "core/picture/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#if defined(__SANITIZE_ADDRESS__)
#define ADAMAS_HAS_LEAK_DETECTION
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ADAMAS_HAS_LEAK_DETECTION
#endif
#endif
#ifdef ADAMAS_HAS_LEAK_DETECTION
#include <sanitizer/lsan_interface.h>
#endif

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/picture/markup.h"

namespace adamas::picture {
namespace {

constexpr double kPointsPerUnit = 0.5;
constexpr double kGreatestSide = 32767;

cairo_status_t append(void* closure, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
  return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) fail("picture: Cairo failed: {}", cairo_status_to_string(status));
}

// Fontconfig keeps its patterns by offsets, which leak detection reports as lost; so its allocations are not
// watched.
class UnwatchedAllocations {
 public:
#ifdef ADAMAS_HAS_LEAK_DETECTION
  UnwatchedAllocations() { __lsan_disable(); }
  ~UnwatchedAllocations() { __lsan_enable(); }
#else
  UnwatchedAllocations() {}
  ~UnwatchedAllocations() {}
#endif
  UnwatchedAllocations(const UnwatchedAllocations&) = delete;
  UnwatchedAllocations& operator=(const UnwatchedAllocations&) = delete;
};

// Fonts with the same outlines and advances for every format: no hinting, grey antialiasing. They live as
// long as the program: fontconfig loses memory each time one is looked up again.
class Fonts {
 public:
  static const Fonts& get() {
    static const Fonts* const kFonts = new Fonts;
    return *kFonts;
  }
  void choose(cairo_t* cairo, const TextStyle& style) const {
    cairo_set_font_face(cairo, faces_[style.bold ? 1 : 0]);
    cairo_set_font_size(cairo, style.size);
    cairo_set_font_options(cairo, options_);
  }

 private:
  Fonts() : options_(cairo_font_options_create()) {
    for (const int bold : {0, 1}) {
      faces_[bold] =
          cairo_toy_font_face_create("DejaVu Sans Condensed", CAIRO_FONT_SLANT_NORMAL,
                                     bold != 0 ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    }
    cairo_font_options_set_hint_style(options_, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options_, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options_, CAIRO_ANTIALIAS_GRAY);
  }

  cairo_font_face_t* faces_[2];
  cairo_font_options_t* options_;
};

class Measurer {
 public:
  Measurer() : surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1)), cairo_(cairo_create(surface_)) {}
  ~Measurer() {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  Measurer(const Measurer&) = delete;
  Measurer& operator=(const Measurer&) = delete;

  double advance(const std::string& text, const TextStyle& style) const {
    Fonts::get().choose(cairo_, style);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, text.c_str(), &extents);
    return extents.x_advance;
  }

 private:
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

}  // namespace

double text_width(std::string_view text, const TextStyle& style) {
  const UnwatchedAllocations unwatched;
  return Measurer().advance(one_line(text), style);
}

std::string shortened(std::string_view text, const TextStyle& style, double width) {
  std::string line = one_line(text);
  if (text_width(line, style) <= width) return line;
  const std::string ellipsis = "…";
  while (!line.empty() && text_width(line + ellipsis, style) > width) {
    while ((static_cast<unsigned char>(line.back()) & 0xC0u) == 0x80) line.pop_back();
    line.pop_back();
  }
  return line + ellipsis;
}

struct Canvas::Parts {
  PictureFormat format;
  double width, height;
  std::string bytes;
  std::vector<std::string> texts;
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;

  void set_colour(const Colour& c, double opacity) const {
    cairo_set_source_rgba(cairo, c.r, c.g, c.b, opacity);
  }
  void trace(std::span<const Vec2> points, bool closed) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
      (i == 0 ? cairo_move_to : cairo_line_to)(cairo, points[i].x, points[i].y);
    }
    if (closed) cairo_close_path(cairo);
  }
  void stroke_path(const Stroke& stroke) const {
    set_colour(stroke.colour, stroke.opacity);
    cairo_set_line_width(cairo, stroke.width);
    cairo_set_dash(cairo, stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0);
    cairo_stroke(cairo);
  }
};

Canvas::Canvas(PictureFormat format, double width, double height)
    : parts_(new Parts{format, std::ceil(width), std::ceil(height), {}, {}}) {
  if (!(width >= 1 && height >= 1 && width <= kGreatestSide && height <= kGreatestSide)) {
    fail("picture: expected sides of 1 to {} units, found {} x {}", kGreatestSide, width, height);
  }
  Parts& p = *parts_;
  const double w = kPointsPerUnit * p.width, h = kPointsPerUnit * p.height;
  if (format == PictureFormat::kPng) {
    p.surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(p.width), static_cast<int>(p.height));
  } else if (format == PictureFormat::kSvg) {
    p.surface = cairo_svg_surface_create_for_stream(append, &p.bytes, w, h);
  } else {
    p.surface = cairo_pdf_surface_create_for_stream(append, &p.bytes, w, h);
  }
  p.cairo = cairo_create(p.surface);
  if (format != PictureFormat::kPng) cairo_scale(p.cairo, kPointsPerUnit, kPointsPerUnit);
  cairo_set_line_join(p.cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(p.cairo, CAIRO_LINE_CAP_BUTT);
  fill_box({{0, 0}, {p.width, p.height}}, {1, 1, 1});
}

Canvas::~Canvas() {
  cairo_destroy(parts_->cairo);
  cairo_surface_destroy(parts_->surface);
}

void Canvas::polyline(std::span<const Vec2> points, const Stroke& stroke, bool closed) {
  parts_->trace(points, closed);
  parts_->stroke_path(stroke);
}

void Canvas::segments(std::span<const Vec2> points, const Stroke& stroke) {
  cairo_save(parts_->cairo);
  cairo_set_line_cap(parts_->cairo, CAIRO_LINE_CAP_ROUND);
  // Paths are kept short: for one long path Cairo takes time that grows faster than its length.
  constexpr std::size_t kSegmentsPerPath = 64;
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
    cairo_move_to(parts_->cairo, points[i].x, points[i].y);
    cairo_line_to(parts_->cairo, points[i + 1].x, points[i + 1].y);
    if ((i / 2 + 1) % kSegmentsPerPath == 0) parts_->stroke_path(stroke);
  }
  parts_->stroke_path(stroke);
  cairo_restore(parts_->cairo);
}

void Canvas::fill(std::span<const Vec2> points, const Colour& colour, double opacity) {
  parts_->trace(points, true);
  parts_->set_colour(colour, opacity);
  cairo_fill(parts_->cairo);
}

void Canvas::fill_box(const Box2& box, const Colour& colour, double opacity) {
  const Vec2 size = box.size();
  cairo_rectangle(parts_->cairo, box.min.x, box.min.y, size.x, size.y);
  parts_->set_colour(colour, opacity);
  cairo_fill(parts_->cairo);
}

void Canvas::disc(const Vec2& centre, double radius, const Colour& colour) {
  cairo_new_sub_path(parts_->cairo);
  cairo_arc(parts_->cairo, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  parts_->set_colour(colour, 1);
  cairo_fill(parts_->cairo);
}

void Canvas::text(std::string_view text, const Vec2& at, const TextStyle& style, Anchor anchor,
                  double angle) {
  cairo_t* cairo = parts_->cairo;
  const std::string line = one_line(text);
  if (line.empty()) return;
  const UnwatchedAllocations unwatched;
  parts_->texts.push_back(line);
  const double shift = anchor == Anchor::kStart ? 0 : anchor == Anchor::kMiddle ? 0.5 : 1;
  const double width = shift > 0 ? text_width(line, style) : 0;
  cairo_save(cairo);
  Fonts::get().choose(cairo, style);
  cairo_translate(cairo, at.x, at.y);
  cairo_rotate(cairo, -angle * std::numbers::pi / 180);
  cairo_move_to(cairo, -shift * width, 0);
  parts_->set_colour(style.colour, 1);
  cairo_show_text(cairo, line.c_str());
  cairo_new_path(cairo);
  cairo_restore(cairo);
}

void Canvas::image(const Raster& raster, const Box2& box) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, raster.width(), raster.height());
  check(cairo_surface_status(surface));
  cairo_surface_flush(surface);
  unsigned char* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  for (int y = 0; y < raster.height(); ++y) {
    unsigned char* row = data + static_cast<std::size_t>(y) * stride;
    for (int x = 0; x < raster.width(); ++x) {
      const Raster::Pixel& p = raster.at(x, y);
      const auto premultiplied = [&](std::uint32_t v) { return (v * p.a + 127) / 255; };
      const std::uint32_t word = (static_cast<std::uint32_t>(p.a) << 24) | (premultiplied(p.r) << 16) |
                                 (premultiplied(p.g) << 8) | premultiplied(p.b);
      std::memcpy(row + 4 * static_cast<std::size_t>(x), &word, sizeof word);
    }
  }
  cairo_surface_mark_dirty(surface);
  cairo_t* cairo = parts_->cairo;
  const Vec2 size = box.size();
  cairo_save(cairo);
  cairo_translate(cairo, box.min.x, box.min.y);
  cairo_scale(cairo, size.x / raster.width(), size.y / raster.height());
  cairo_set_source_surface(cairo, surface, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
  cairo_paint(cairo);
  cairo_restore(cairo);
  cairo_surface_destroy(surface);
}

void Canvas::clip(const Box2& box) {
  cairo_save(parts_->cairo);
  const Vec2 size = box.size();
  cairo_rectangle(parts_->cairo, box.min.x, box.min.y, size.x, size.y);
  cairo_clip(parts_->cairo);
}

void Canvas::unclip() { cairo_restore(parts_->cairo); }

Raster Canvas::pixels() const {
  ADAMAS_ASSERT(parts_->format == PictureFormat::kPng);
  cairo_surface_flush(parts_->surface);
  Raster raster(static_cast<int>(parts_->width), static_cast<int>(parts_->height));
  const unsigned char* data = cairo_image_surface_get_data(parts_->surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(parts_->surface));
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      std::uint32_t word = 0;
      std::memcpy(&word, data + static_cast<std::size_t>(y) * stride + 4 * static_cast<std::size_t>(x),
                  sizeof word);
      const auto byte = [word](int shift) { return static_cast<std::uint8_t>(word >> shift & 0xffu); };
      raster.at(x, y) = {byte(16), byte(8), byte(0), 255};
    }
  }
  return raster;
}

std::string Canvas::finish(std::string_view title) {
  Parts& p = *parts_;
  check(cairo_status(p.cairo));
  if (p.format == PictureFormat::kPdf) {
    cairo_pdf_surface_set_metadata(p.surface, CAIRO_PDF_METADATA_TITLE, one_line(title).c_str());
    // The date is fixed; otherwise the current time would be written into the file.
    cairo_pdf_surface_set_metadata(p.surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  }
  if (p.format == PictureFormat::kPng) {
    cairo_surface_flush(p.surface);
    check(cairo_surface_write_to_png_stream(p.surface, append, &p.bytes));
    return std::move(p.bytes);
  }
  cairo_surface_finish(p.surface);
  check(cairo_surface_status(p.surface));
  if (p.format == PictureFormat::kSvg) {
    p.bytes = renumbered_svg(p.bytes);
    std::string description;
    for (const std::string& text : p.texts)
      description += (description.empty() ? "" : "; ") + escape_markup(text);
    const std::size_t tag = p.bytes.find("<svg"),
                      end = tag == std::string::npos ? tag : p.bytes.find('>', tag);
    if (end == std::string::npos) fail("picture: Cairo failed: no SVG element");
    p.bytes.insert(
        end + 1, "\n<title>" + escape_markup(one_line(title)) + "</title>\n<desc>" + description + "</desc>");
  }
  return std::move(p.bytes);
}

void write_png(const std::filesystem::path& path, const Raster& raster) {
  const double width = raster.width(), height = raster.height();
  Canvas canvas(PictureFormat::kPng, width, height);
  canvas.image(raster, {{0, 0}, {width, height}});
  write_bytes(path, canvas.finish(""));
}

}  // namespace adamas::picture
