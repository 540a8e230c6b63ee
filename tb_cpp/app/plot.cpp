// SPDX-License-Identifier: Apache-2.0
#include "app/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <system_error>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"

namespace dtof {
namespace {

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

std::string gnuplot_script(const std::filesystem::path& output, const std::vector<PlotSeries>& series,
                           const PlotLayout& layout) {
  std::string script = fmt::format(
      "set terminal svg size 900,560 font 'sans,13' background '#ffffff'\n"
      "set output {}\nset title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n"
      "set key outside right noenhanced\nset grid\nset autoscale xfix\n{}{}{}",
      quoted(output.string()), quoted(layout.title), quoted(layout.x_label), quoted(layout.y_label),
      layout.logarithmic_y ? "set logscale y\n" : "", layout.logarithmic_x ? "set logscale x\n" : "",
      layout.logarithmic_x ? logarithmic_marks(series) : "");
  std::string plots;
  for (std::size_t i = 0; i < series.size(); ++i) {
    script += fmt::format("$series{} << END\n", i);
    for (std::size_t k = 0; k < series[i].x.size(); ++k) {
      if (std::isfinite(series[i].x[k]) && std::isfinite(series[i].y[k])) {
        script += fmt::format("{:.9g} {:.9g}\n", series[i].x[k], series[i].y[k]);
      }
    }
    script += "END\n";
    plots +=
        fmt::format("{}$series{} using 1:2 with {} title {}", i == 0 ? "plot " : ", ", i,
                    layout.markers ? fmt::format("linespoints linewidth 1.5 pointtype {}", i + 4) : "lines",
                    quoted(series[i].label));
  }
  for (const double limit : layout.y_limits) {
    plots += fmt::format(", {:.9g} with lines dashtype 2 linecolor rgb 'black' notitle", limit);
  }
  return script + plots + "\n";
}

}  // namespace

void write_plot(const std::filesystem::path& path, const std::vector<PlotSeries>& series,
                const PlotLayout& layout) {
  const std::filesystem::path drawn = std::filesystem::path(path).concat(".gnuplot");
  std::error_code ignored;
  {
    struct Close {
      int* status;
      void operator()(std::FILE* pipe) const { *status = pclose(pipe); }
    };
    int status = -1;
    {
      const std::unique_ptr<std::FILE, Close> pipe(popen("gnuplot", "w"), Close{&status});
      if (pipe == nullptr) {
        throw InputError(fmt::format("{}: cannot plot: gnuplot does not start", path.string()));
      }
      fmt::print(pipe.get(), "{}", gnuplot_script(drawn, series, layout));
    }
    if (status != 0) {
      std::filesystem::remove(drawn, ignored);
      throw InputError(fmt::format("{}: cannot plot: gnuplot failed (is it installed?)", path.string()));
    }
  }
  const std::string picture = read_file(drawn);
  std::filesystem::remove(drawn, ignored);
  write_file(path, picture);
}

}  // namespace dtof
