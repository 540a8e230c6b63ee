// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/output_error.hpp"
#include "dtof/report/utf8.hpp"

namespace dtof {
namespace {

constexpr auto kStyles = std::to_array<PlotStyle>({
#include "plot_styles.inc"
});

/// For series that are no read-out's, e.g. photon models: by their place in the picture.
constexpr std::array<std::string_view, 8> kOtherColours = {"#4c72b0", "#dd8452", "#55a868", "#c44e52",
                                                           "#8172b3", "#937860", "#da8bc3", "#64b5cd"};
constexpr std::array<int, 8> kOtherMarkers = {7, 5, 9, 13, 6, 4, 8, 12};
constexpr int kDashes = 5;  ///< dash types that can be told apart

/// The style of every series: further series of one read-out take other dashes.
std::vector<PlotStyle> styles_of(const std::vector<PlotSeries>& series) {
  std::vector<PlotStyle> styles;
  std::map<std::string_view, int> seen;
  std::size_t others = 0;
  for (const PlotSeries& line : series) {
    if (std::optional<PlotStyle> style = plot_style(line.label)) {
      style->dash = 1 + (style->dash - 1 + 2 * seen[style->title]++) % kDashes;
      styles.push_back(*style);
    } else {
      const std::size_t place = others % kOtherColours.size();
      const auto round = static_cast<int>(others / kOtherColours.size());
      styles.push_back({line.label, kOtherColours.at(place), kOtherMarkers.at(place),
                        1 + (static_cast<int>(place) + round) % kDashes});
      ++others;
    }
  }
  return styles;
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    out += c;
    if (c == '\'') {
      out += '\'';
    }
  }
  return out + "'";
}

/// What a picture shows, which may hold a file's name.
std::string quoted_text(const std::string& text) { return quoted(as_utf8(text)); }

/// Marks at 1, 2 and 5 of every decade, where gnuplot would label the decades only.
std::string logarithmic_marks(const std::vector<PlotSeries>& series) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const PlotSeries& line : series) {
    for (const double x : line.x) {
      if (std::isfinite(x) && x > 0.0) {
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
  }
  constexpr double kFewDecades = 1e3;
  if (high == 0.0 || high > kFewDecades * low) {
    return "";
  }
  std::string marks;
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int decade = static_cast<int>(std::floor(std::log10(low))); decade <= last; ++decade) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double mark = digit * std::pow(10.0, decade);
      if (mark < 0.999 * low || mark > 1.001 * high) {
        continue;  // gnuplot would make room for its label
      }
      marks += fmt::format("{}'{:g}' {:.9g}", marks.empty() ? "" : ", ", mark, mark);
    }
  }
  return fmt::format("set xtics ({})\n", marks);
}

/// The series as data blocks $series0, $series1, ...: x, y and, with a band, its lower and upper end.
std::string data_blocks(const std::vector<PlotSeries>& series) {
  std::string blocks;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const PlotSeries& line = series[i];
    blocks += fmt::format("$series{} << END\n", i);
    for (std::size_t k = 0; k < line.x.size(); ++k) {
      if (std::isfinite(line.x[k]) && std::isfinite(line.y[k])) {
        blocks += fmt::format("{:.9g} {:.9g}", line.x[k], line.y[k]);
        blocks += line.low.empty() ? "\n" : fmt::format(" {:.9g} {:.9g}\n", line.low[k], line.high[k]);
      }
    }
    blocks += "END\n";
  }
  return blocks;
}

/// What `plot` draws of a series: its band, if any, then its line.
std::string drawn_series(const PlotSeries& line, std::size_t index, const PlotStyle& style,
                         const PlotLayout& layout) {
  std::string drawn;
  if (!line.low.empty()) {
    drawn = fmt::format(
        "$series{} using 1:3:4 with filledcurves linecolor rgb '{}' fillstyle transparent solid 0.25 "
        "notitle, ",
        index, style.colour);
  }
  const std::string with = layout.markers ? fmt::format("linespoints pointtype {}", style.marker) : "lines";
  return drawn +
         fmt::format("$series{} using 1:2 with {} linewidth 1.5 linecolor rgb '{}' dashtype {} title {}",
                     index, with, style.colour, style.dash, layout.panels ? "''" : quoted_text(line.label));
}

std::string limits(const PlotLayout& layout) {
  std::string lines;
  for (const double limit : layout.y_limits) {
    lines += fmt::format(", {:.9g} with lines dashtype 2 linecolor rgb 'black' notitle", limit);
  }
  return lines;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(const std::vector<double>& values) {
    for (const double value : values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  /// 1, 2 or 5 times a power of ten, for at most about so many ticks.
  [[nodiscard]] double tick_step(double most) const {
    if (!(high > low)) {
      return 1.0;
    }
    const double raw = (high - low) / most;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    return power * (raw <= power ? 1.0 : raw <= 2.0 * power ? 2.0 : raw <= 5.0 * power ? 5.0 : 10.0);
  }
};

/// One picture for all series, or a panel each.
std::string plots(const std::vector<PlotSeries>& series, const PlotLayout& layout) {
  const std::vector<PlotStyle> styles = styles_of(series);
  if (!layout.panels) {
    std::string all;
    for (std::size_t i = 0; i < series.size(); ++i) {
      all += (i == 0 ? "plot " : ", ") + drawn_series(series[i], i, styles[i], layout);
    }
    return all + limits(layout) + "\n";
  }
  Range x;
  Range y;
  for (const PlotSeries& line : series) {
    x.include(line.x);
    for (const std::vector<double>* values : {&line.y, &line.low, &line.high}) {
      y.include(*values);
    }
  }
  const double margin = y.high > y.low ? 0.05 * (y.high - y.low) : 1.0;
  std::string all =
      fmt::format("set pointsize 0.6\nset xtics {:.9g}\nset ytics {:.9g}\nset yrange [{:.9g}:{:.9g}]\n",
                  x.tick_step(5.0), y.tick_step(6.0), y.low - margin, y.high + margin);
  for (std::size_t i = 0; i < series.size(); ++i) {
    all += fmt::format("set title {} noenhanced\nplot {}{}\n", quoted_text(series[i].label),
                       drawn_series(series[i], i, styles[i], layout), limits(layout));
  }
  return all;
}

std::string gnuplot_script(const std::filesystem::path& output, const std::vector<PlotSeries>& series,
                           const PlotLayout& layout) {
  constexpr std::size_t kPanelsAcross = 5;
  constexpr std::size_t kPanelWidth = 250;
  constexpr std::size_t kPanelHeight = 270;
  std::size_t width = 900;
  std::size_t height = 560;
  std::string heading =
      fmt::format("set title {} noenhanced\nset key outside right noenhanced\n", quoted_text(layout.title));
  if (layout.panels) {
    const std::size_t across = std::clamp<std::size_t>(series.size(), 1, kPanelsAcross);
    const std::size_t down = (series.size() + across - 1) / across;
    width = std::max<std::size_t>(across * kPanelWidth, 700);
    height = down * kPanelHeight + 40;
    heading = fmt::format("set multiplot layout {},{} title {} noenhanced\nunset key\n", down, across,
                          quoted_text(layout.title));
  }
  return fmt::format(
             "set terminal svg size {},{} font 'sans,13' background '#ffffff'\n"
             "set output {}\n{}{}set xlabel {} noenhanced\nset ylabel {} noenhanced\n"
             "set grid\nset autoscale xfix\n{}{}{}",
             width, height, quoted(output.string()), data_blocks(series), heading,
             quoted_text(layout.x_label), quoted_text(layout.y_label),
             layout.logarithmic_y ? "set logscale y\n" : "", layout.logarithmic_x ? "set logscale x\n" : "",
             layout.logarithmic_x ? logarithmic_marks(series) : "") +
         plots(series, layout);
}

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A file for what gnuplot says. It warns of an axis of one value, which it then draws.
using Complaints = std::unique_ptr<std::FILE, FileCloser>;

/// The last line that is not empty, as ": <line>"; empty if there is none.
std::string last_complaint(const Complaints& complaints) {
  std::string last;
  if (complaints) {
    std::rewind(complaints.get());
    for (std::array<char, 512> line{}; std::fgets(line.data(), line.size(), complaints.get()) != nullptr;) {
      std::string text = line.data();
      std::erase(text, '\n');
      last = text.find_first_not_of(' ') == std::string::npos ? last : ": " + text;
    }
  }
  return last;
}

/// Lets gnuplot draw. Throws InputError if it fails.
void run_gnuplot(const std::filesystem::path& path, const std::string& script) {
  struct Close {
    int* status;
    void operator()(std::FILE* pipe) const { *status = pclose(pipe); }
  };
  const Complaints complaints(std::tmpfile());
  const std::string errors =
      complaints ? fmt::format("/dev/fd/{}", ::fileno(complaints.get())) : std::string("/dev/null");
  int status = -1;
  {
    const std::unique_ptr<std::FILE, Close> pipe(popen(("gnuplot 2>" + errors).c_str(), "w"), Close{&status});
    if (pipe == nullptr) {
      throw InputError(fmt::format("{}: cannot plot: gnuplot does not start", path.string()));
    }
    fmt::print(pipe.get(), "{}", script);
  }
  if (status != 0) {
    check_interruption();  // which gnuplot may have got, too
    throw InputError(fmt::format("{}: cannot plot: gnuplot failed (is it installed?){}", path.string(),
                                 last_complaint(complaints)));
  }
}

}  // namespace

std::span<const PlotStyle> plot_styles() { return kStyles; }

std::optional<PlotStyle> plot_style(std::string_view label) {
  std::optional<PlotStyle> found;
  for (const PlotStyle& style : kStyles) {
    const bool begins = label.starts_with(style.title) &&
                        (label.size() == style.title.size() ||
                         std::isalnum(static_cast<unsigned char>(label[style.title.size()])) == 0);
    if (begins && (!found || style.title.size() > found->title.size())) {
      found = style;
    }
  }
  return found;
}

std::string plot_obstacle() {
  return std::system("gnuplot --version > /dev/null 2>&1") == 0 ? ""
                                                                : "gnuplot does not run (is it installed?)";
}

void write_plot(const std::filesystem::path& path, const std::vector<PlotSeries>& series,
                const PlotLayout& layout) {
  const std::filesystem::path drawn = std::filesystem::path(path).concat(".gnuplot");
  std::error_code ignored;
  std::string picture;
  try {
    run_gnuplot(path, gnuplot_script(drawn, series, layout));
    picture = std::filesystem::file_size(drawn) == 0 ? "" : read_file(drawn);
  } catch (...) {
    std::filesystem::remove(drawn, ignored);
    throw;
  }
  std::filesystem::remove(drawn, ignored);
  if (!picture.ends_with("</svg>\n\n") && !picture.ends_with("</svg>\n")) {  // gnuplot overlooks a full disk
    throw OutputError(fmt::format("{}: cannot write: gnuplot's picture is not whole", path.string()));
  }
  write_file(path, picture);
}

}  // namespace dtof
