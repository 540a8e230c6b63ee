// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/colour_png.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/report/colour_map.hpp"
#include "dtof/report/utf8.hpp"

namespace dtof {
namespace {

// Lengths in screen pixels.
constexpr double kMargin = 14.0;
constexpr double kFontSize = 13.0;
constexpr double kTitleSize = 16.0;
constexpr double kLineHeight = 22.0;
constexpr double kBarWidth = 18.0;
constexpr double kBarArea = 92.0;
constexpr double kTickLength = 5.0;
constexpr double kPointLength = 10.0;
constexpr int kWantedMapWidth = 480;
constexpr int kLargestPixelSize = 16;
constexpr int kLargestExtent = 32767;  ///< of a cairo image
constexpr Colour kUnknown = {0.62, 0.62, 0.62};
/// Colours of a scale; odd, so that its middle is one. Few, so that the pictures of noise stay small.
constexpr int kScaleSteps = 65;
constexpr std::size_t kPaletteSize = 256;

struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDeleter {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;

bool is_known(MapKind kind, float value) {
  return std::isfinite(value) && (kind == MapKind::kError || value > 0.0F);
}

/// The scale's colour nearest to a position from 0 to 1.
Colour colour_at(MapKind kind, double position) {
  const double step = std::round(std::clamp(position, 0.0, 1.0) * (kScaleSteps - 1)) / (kScaleSteps - 1);
  return kind == MapKind::kDepth ? viridis(step) : blue_white_red(step);
}

std::uint32_t packed(const Colour& colour) {
  const auto byte = [](double value) { return static_cast<std::uint32_t>(std::lround(value * 255.0)); };
  return byte(colour[0]) << 16U | byte(colour[1]) << 8U | byte(colour[2]);
}

std::array<int, 3> channels(std::uint32_t colour) {
  return {static_cast<int>(colour >> 16U & 0xffU), static_cast<int>(colour >> 8U & 0xffU),
          static_cast<int>(colour & 0xffU)};
}

/// The colours of a picture: a byte a pixel makes files a third as large as three do.
class Palette {
 public:
  explicit Palette(std::span<const MapKind> kinds) {
    colours_.push_back(packed(kUnknown));
    for (const MapKind kind : kinds) {
      for (int step = 0; step < kScaleSteps; ++step) {
        colours_.push_back(packed(colour_at(kind, static_cast<double>(step) / (kScaleSteps - 1))));
      }
    }
    const auto greys = static_cast<int>(kPaletteSize - colours_.size());
    for (int grey = 0; grey < greys; ++grey) {
      const double level = static_cast<double>(grey) / (greys - 1);
      colours_.push_back(packed({level, level, level}));
    }
  }

  [[nodiscard]] const std::vector<std::uint32_t>& colours() const { return colours_; }

  /// Index of the colour; of the nearest one for the edges of text and lines.
  [[nodiscard]] std::uint8_t index(std::uint32_t colour) {
    const auto [place, is_new] = indices_.try_emplace(colour, std::uint8_t{0});
    if (is_new) {
      const auto distance = [wanted = channels(colour)](std::uint32_t candidate) {
        int sum = 0;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
          const int difference = channels(candidate).at(i) - wanted.at(i);
          sum += difference * difference;
        }
        return sum;
      };
      place->second =
          static_cast<std::uint8_t>(std::ranges::min_element(colours_, {}, distance) - colours_.begin());
    }
    return place->second;
  }

 private:
  std::vector<std::uint32_t> colours_;
  std::unordered_map<std::uint32_t, std::uint8_t> indices_;
};

/// A scale and whether values beyond its ends occur.
struct Scale {
  MapKind kind = MapKind::kDepth;
  ColourRange range;
  bool values_below = false;
  bool values_above = false;

  [[nodiscard]] Colour colour(double value) const {
    return colour_at(kind, (value - range.lowest) / (range.highest - range.lowest));
  }
};

Scale make_scale(MapKind kind, std::span<const MapPanel> panels, const PictureLayout& layout) {
  Scale scale{.kind = kind, .range = {}};
  if (kind == MapKind::kDepth) {
    scale.range = layout.depth_range ? *layout.depth_range : depth_range(panels);
  } else {
    const double largest = layout.largest_error ? *layout.largest_error : error_range(panels);
    scale.range = {.lowest = -largest, .highest = largest};
  }
  if (!std::isfinite(scale.range.lowest) || !std::isfinite(scale.range.highest) ||
      scale.range.lowest >= scale.range.highest) {
    throw InputError(fmt::format("picture: colour range {}..{} m is empty or not finite", scale.range.lowest,
                                 scale.range.highest));
  }
  for (const MapPanel& panel : panels) {
    for (const float value : panel.image.metres) {
      if (panel.kind == kind && is_known(kind, value)) {
        scale.values_below |= double{value} < scale.range.lowest;
        scale.values_above |= double{value} > scale.range.highest;
      }
    }
  }
  return scale;
}

/// Step of 1, 2 or 5 times a power of ten that gives at most about six ticks.
double tick_step(const ColourRange& range) {
  const double raw = (range.highest - range.lowest) / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  return power * (mantissa <= 1.0 ? 1.0 : mantissa <= 2.0 ? 2.0 : mantissa <= 5.0 ? 5.0 : 10.0);
}

class Picture {
 public:
  Picture(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        context_(cairo_create(surface_.get())) {
    if (cairo_status(context_.get()) != CAIRO_STATUS_SUCCESS) {
      throw InputError(fmt::format("picture: {} x {}: {}", width, height,
                                   cairo_status_to_string(cairo_status(context_.get()))));
    }
    cairo_set_source_rgb(context_.get(), 1.0, 1.0, 1.0);
    cairo_paint(context_.get());
  }

  /// `y` is the baseline.
  void text(double x, double y, double size, const std::string& text, bool bold = false) {
    cairo_t* const cr = context_.get();
    cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
    cairo_set_source_rgb(cr, 0.0, 0.0, 0.0);
    cairo_move_to(cr, x, y);
    cairo_show_text(cr, as_utf8(text).c_str());
  }

  void map(double x, double y, const DepthImage& image, const Scale& scale, int pixel_size) {
    const Surface pixels(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
    unsigned char* const data = cairo_image_surface_get_data(pixels.get());
    const int stride = cairo_image_surface_get_stride(pixels.get());
    for (int row = 0; row < image.height; ++row) {
      auto* const line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
      for (int column = 0; column < image.width; ++column) {
        const float value = image.at(column, row);
        line[column] = packed(is_known(scale.kind, value) ? scale.colour(value) : kUnknown);
      }
    }
    cairo_surface_mark_dirty(pixels.get());
    cairo_t* const cr = context_.get();
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_scale(cr, pixel_size, pixel_size);
    cairo_set_source_surface(cr, pixels.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    cairo_rectangle(cr, 0.0, 0.0, image.width, image.height);
    cairo_fill(cr);
    cairo_restore(cr);
    frame(x, y, image.width * pixel_size, image.height * pixel_size);
  }

  void scale_bar(double x, double y, double height, const Scale& scale) {
    cairo_t* const cr = context_.get();
    const auto steps = static_cast<int>(height);
    for (int step = 0; step < steps; ++step) {
      const Colour colour = colour_at(scale.kind, 1.0 - (step + 0.5) / steps);
      cairo_set_source_rgb(cr, colour[0], colour[1], colour[2]);
      cairo_rectangle(cr, x, y + step, kBarWidth, 1.0);
      cairo_fill(cr);
    }
    frame(x, y, kBarWidth, steps);
    const ColourRange& range = scale.range;
    const double step = tick_step(range);
    const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    const double first = std::ceil(range.lowest / step - 1e-9);
    const auto count = static_cast<int>(std::floor(range.highest / step + 1e-9) - first) + 1;
    for (int tick = 0; tick < count; ++tick) {
      const double value = (first + tick) * step;
      const double at =
          std::round(y + steps * (range.highest - value) / (range.highest - range.lowest)) - 0.5;
      cairo_set_line_width(cr, 1.0);
      cairo_move_to(cr, x + kBarWidth, at);
      cairo_line_to(cr, x + kBarWidth + kTickLength, at);
      cairo_stroke(cr);
      text(x + kBarWidth + kTickLength + 3.0, at + kFontSize * 0.36, kFontSize,
           fmt::format("{:.{}f}", value == 0.0 ? 0.0 : value, digits));
    }
    text(x, y - kPointLength - 7.0, kFontSize, scale.kind == MapKind::kDepth ? "depth, m" : "error, m");
    if (scale.values_above) {
      point(x, y - 1.0, -kPointLength, colour_at(scale.kind, 1.0));
    }
    if (scale.values_below) {
      point(x, y + steps + 1.0, kPointLength, colour_at(scale.kind, 0.0));
    }
  }

  [[nodiscard]] double text_width(const std::string& text, double size, bool bold) {
    cairo_t* const cr = context_.get();
    cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
    cairo_text_extents_t extents{};
    cairo_text_extents(cr, as_utf8(text).c_str(), &extents);
    return extents.x_advance;
  }

  [[nodiscard]] std::string png(Palette palette) const {
    if (const cairo_status_t status = cairo_status(context_.get()); status != CAIRO_STATUS_SUCCESS) {
      throw InputError(fmt::format("picture: {}", cairo_status_to_string(status)));
    }
    cairo_surface_flush(surface_.get());
    const int width = cairo_image_surface_get_width(surface_.get());
    const int height = cairo_image_surface_get_height(surface_.get());
    const unsigned char* const data = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    std::vector<std::uint8_t> indices;
    indices.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int row = 0; row < height; ++row) {
      const auto* const line =
          reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
      for (int column = 0; column < width; ++column) {
        indices.push_back(palette.index(line[column] & 0xffffffU));
      }
    }
    std::vector<png_byte> map;
    for (const std::uint32_t colour : palette.colours()) {
      for (const int channel : channels(colour)) {
        map.push_back(static_cast<png_byte>(channel));
      }
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGB_COLORMAP;
    image.colormap_entries = static_cast<png_uint_32>(palette.colours().size());
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string encoded(size, '\0');
    if (png_image_write_to_memory(&image, encoded.data(), &size, 0, indices.data(), 0, map.data()) == 0) {
      throw InputError(fmt::format("picture: {}", image.message));
    }
    encoded.resize(size);
    return encoded;
  }

 private:
  /// Triangle on an end of the bar: values lie beyond it.
  void point(double x, double y, double length, const Colour& colour) {
    cairo_t* const cr = context_.get();
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + kBarWidth / 2.0, y + length);
    cairo_line_to(cr, x + kBarWidth, y);
    cairo_close_path(cr);
    cairo_set_source_rgb(cr, colour[0], colour[1], colour[2]);
    cairo_fill_preserve(cr);
    cairo_set_source_rgb(cr, 0.0, 0.0, 0.0);
    cairo_stroke(cr);
  }

  void frame(double x, double y, double width, double height) {
    cairo_t* const cr = context_.get();
    cairo_set_source_rgb(cr, 0.0, 0.0, 0.0);
    cairo_set_line_width(cr, 1.0);
    cairo_rectangle(cr, x - 0.5, y - 0.5, width + 1.0, height + 1.0);
    cairo_stroke(cr);
  }

  Surface surface_;
  Context context_;
};

/// Breaks `text` at spaces into lines of at most `width` (a longer word keeps its own line).
std::vector<std::string> wrap(Picture& ruler, const std::string& text, double size, bool bold, double width) {
  std::vector<std::string> lines;
  std::string line;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    const std::string word(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    std::string longer = line;
    if (!line.empty()) {
      longer += ' ';
    }
    longer += word;
    if (!line.empty() && ruler.text_width(longer, size, bold) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) {
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

ColourRange depth_range(std::span<const MapPanel> panels) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0.0;
  for (const MapPanel& panel : panels) {
    for (const float value : panel.image.metres) {
      if (panel.kind == MapKind::kDepth && is_known(panel.kind, value)) {
        lowest = std::min(lowest, double{value});
        highest = std::max(highest, double{value});
      }
    }
  }
  if (highest == 0.0) {
    return {};
  }
  // A flat scene still needs a scale: 1 % of its depth to either side.
  if (highest - lowest < 1e-6 * highest) {
    return {.lowest = 0.99 * lowest, .highest = 1.01 * highest};
  }
  return {.lowest = lowest, .highest = highest};
}

double error_range(std::span<const MapPanel> panels) {
  constexpr double kSmallest = 1e-3;
  std::vector<double> sizes;
  for (const MapPanel& panel : panels) {
    for (const float value : panel.image.metres) {
      if (panel.kind == MapKind::kError && is_known(panel.kind, value)) {
        sizes.push_back(std::abs(double{value}));
      }
    }
  }
  if (sizes.empty()) {
    return kSmallest;
  }
  const auto rank = static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
  return std::max(kSmallest, sizes[static_cast<std::size_t>(rank)]);
}

void write_map_picture(const std::filesystem::path& path, std::span<const MapPanel> panels,
                       const PictureLayout& layout) {
  if (panels.empty() || layout.panels_per_row < 1 || layout.pixel_size < 0) {
    throw InputError(fmt::format("picture: {} maps, {} in a row, pixel size {}", panels.size(),
                                 layout.panels_per_row, layout.pixel_size));
  }
  int map_width = 0;
  int map_height = 0;
  for (const MapPanel& panel : panels) {
    const DepthImage& image = panel.image;
    if (image.width < 1 || image.height < 1 ||
        image.metres.size() !=
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
      throw InputError(fmt::format("picture: {} values for {} x {} pixels", image.metres.size(), image.width,
                                   image.height));
    }
    map_width = std::max(map_width, image.width);
    map_height = std::max(map_height, image.height);
  }
  const int pixel_size = layout.pixel_size > 0 ? layout.pixel_size
                                               : std::clamp(kWantedMapWidth / std::max(map_width, map_height),
                                                            1, kLargestPixelSize);

  std::vector<Scale> scales;
  for (const MapKind kind : {MapKind::kDepth, MapKind::kError}) {
    if (std::ranges::any_of(panels, [&](const MapPanel& panel) { return panel.kind == kind; })) {
      scales.push_back(make_scale(kind, panels, layout));
    }
  }

  const int across = std::min(layout.panels_per_row, static_cast<int>(panels.size()));
  const int down = (static_cast<int>(panels.size()) + across - 1) / across;
  const double cell_width = map_width * pixel_size + kMargin;
  const double cell_height = map_height * pixel_size + kLineHeight + kMargin / 2.0;
  Picture ruler(1, 1);
  constexpr double kSmallestWidth = 360.0;
  const double width =
      std::max(kSmallestWidth, across * cell_width + kMargin + static_cast<double>(scales.size()) * kBarArea);
  const double text_width = width - 2.0 * kMargin;
  const auto title = wrap(ruler, layout.title, kTitleSize, true, text_width);
  const auto caption = wrap(ruler, layout.caption, kFontSize * 0.85, false, text_width);
  const double title_height = static_cast<double>(title.size()) * kLineHeight + kMargin;
  constexpr double kSmallestBar = 110.0;
  const double grid_height =
      std::max(down * cell_height, kSmallestBar + kLineHeight + 2.0 * kPointLength) + kMargin;
  const double height =
      title_height + grid_height + static_cast<double>(caption.size()) * kFontSize * 1.3 + kMargin;
  if (width > kLargestExtent || height > kLargestExtent) {
    throw InputError(fmt::format("{}: the picture would be {:.0f} x {:.0f} pixels, at most {} are possible",
                                 path.string(), width, height, kLargestExtent));
  }

  Picture picture(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)));
  double y = kMargin;
  for (const std::string& line : title) {
    picture.text(kMargin, y + kTitleSize * 0.9, kTitleSize, line, true);
    y += kLineHeight;
  }
  const double grid_top = title_height;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const int row = static_cast<int>(i) / across;
    const int column = static_cast<int>(i) % across;
    const double x = kMargin + column * cell_width;
    const double top = grid_top + row * cell_height;
    const double label_width = std::max(1.0, picture.text_width(panels[i].label, kFontSize, false));
    const double room = across > 1 ? cell_width - 4.0 : text_width;
    picture.text(x, top + kLineHeight - 7.0, kFontSize * std::min(1.0, room / label_width), panels[i].label);
    const Scale& scale = *std::ranges::find(scales, panels[i].kind, &Scale::kind);
    picture.map(x, top + kLineHeight, panels[i].image, scale, pixel_size);
  }
  const double bar_height = std::max(
      kSmallestBar, std::min(down * cell_height - kLineHeight - kMargin / 2.0 - 2.0 * kPointLength, 480.0));
  for (std::size_t i = 0; i < scales.size(); ++i) {
    picture.scale_bar(kMargin + across * cell_width + static_cast<double>(i) * kBarArea,
                      grid_top + kLineHeight + kPointLength, bar_height, scales[i]);
  }
  y = grid_top + grid_height;
  for (const std::string& line : caption) {
    picture.text(kMargin, y + kFontSize * 0.5, kFontSize * 0.85, line);
    y += kFontSize * 1.3;
  }
  std::vector<MapKind> kinds;
  kinds.reserve(scales.size());
  for (const Scale& scale : scales) {
    kinds.push_back(scale.kind);
  }
  write_file(path, picture.png(Palette(kinds)));
}

}  // namespace dtof
