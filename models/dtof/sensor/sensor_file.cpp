// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/sensor_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/suggestion.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/sensor/sensor_keys.hpp"

namespace dtof {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

class SensorReader {
 public:
  /// `base`: what the file changes; none: the file says all.
  SensorReader(const toml::table& root, std::filesystem::path path, const SensorModel* base = nullptr)
      : root_(root), path_(std::move(path)), base_(base) {}

  SensorModel read() {
    check_names();
    SensorDraft draft;
    if (base_ != nullptr) {
      draft.model = *base_;
    } else {
      draft.model.dark_count_rate_hz = 0.0;
      draft.model.name = read_name();
    }
    const bool optics = root_.contains("optics");
    const bool response = find("laser", "pulse_response_file") != nullptr;
    for (const SensorNumberKey& key : sensor_number_keys()) {
      const toml::node* node = find(key.section, key.name);
      if (node != nullptr) {
        if (optics && key.need == SensorKeyNeed::kWithoutOptics) {
          fail(*node, fmt::format("{} follows from [optics]: give one of the two", key.name));
        }
        if (response && key.need == SensorKeyNeed::kWithoutResponse) {
          fail(*node, fmt::format("{} follows from pulse_response_file: give one of the two", key.name));
        }
        key.set(draft, number(key, *node));
      } else if (base_ != nullptr && key.need != SensorKeyNeed::kWithSection) {
        continue;
      } else if (key.need == SensorKeyNeed::kAlways ||
                 key.need == (optics ? SensorKeyNeed::kWithOptics : SensorKeyNeed::kWithoutOptics) ||
                 (key.need == SensorKeyNeed::kWithoutResponse && !response) ||
                 (key.need == SensorKeyNeed::kWithSection && root_.contains(key.section))) {
        fail_in(key.section, fmt::format("[{}] has no {} ({})", key.section, key.name, key.meaning));
      }
    }
    read_response(draft);
    if (optics) {
      apply_optics(draft);
    }
    if (draft.model.pulse_fwhm_s >= draft.model.integration_time_s) {
      fail_in("laser", fmt::format("a pulse of {:g} ns does not fit into a range of {:g} ns",
                                   draft.model.pulse_fwhm_s * kNanosecondsPerSecond,
                                   draft.model.integration_time_s * kNanosecondsPerSecond));
    }
    read_code_widths(draft.model);
    read_detector(draft.model);
    read_surroundings(draft.model.surroundings);
    try {
      draft.model.validate();
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", path_.string(), error.what()));
    }
    return draft.model;
  }

 private:
  [[noreturn]] void fail_at(const toml::source_region& source, std::string_view reason) const {
    fail_at_line(path_.string(), source.begin.line, reason);
  }
  [[noreturn]] void fail(const toml::node& node, std::string_view reason) const {
    fail_at(node.source(), reason);
  }
  /// At the section's head, or at the file's begin without one.
  [[noreturn]] void fail_in(std::string_view section, std::string_view reason) const {
    const toml::node* node = root_.get(section);
    fail(node != nullptr ? *node : root_, reason);
  }

  [[nodiscard]] const toml::node* find(std::string_view section, std::string_view key) const {
    const toml::node* table = root_.get(section);
    return table == nullptr ? nullptr : table->as_table()->get(key);
  }

  void check_names() const {
    for (const auto& [name, node] : root_) {
      if (name == "name") {
        continue;
      }
      const std::span<const std::string_view> sections = sensor_sections();
      if (std::ranges::find(sections, name.str()) == sections.end()) {
        std::vector<std::string_view> known(sections.begin(), sections.end());
        known.emplace_back("name");
        fail_at(name.source(),
                unknown_name(node.is_table() ? "section" : "key outside of a section", name.str(), known));
      }
      if (!node.is_table()) {
        fail_at(name.source(), fmt::format("'{0}' must be a section, [{0}]", name.str()));
      }
      check_section(name.str(), *node.as_table());
    }
  }

  void check_section(std::string_view section, const toml::table& table) const {
    const std::vector<std::string_view> known = sensor_keys_of(section);
    for (const auto& [name, node] : table) {
      if (std::ranges::find(known, name.str()) != known.end()) {
        continue;
      }
      for (const std::string_view other : sensor_sections()) {
        const std::vector<std::string_view> keys = sensor_keys_of(other);
        if (std::ranges::find(keys, name.str()) != keys.end()) {
          fail_at(name.source(), fmt::format("{} belongs to [{}], not to [{}]", name.str(), other, section));
        }
      }
      fail_at(name.source(), unknown_name(fmt::format("key of [{}]", section), name.str(), known));
    }
  }

  [[nodiscard]] std::string read_name() const {
    const toml::node* node = root_.get("name");
    if (node == nullptr) {
      return path_.stem().string();
    }
    if (!node->is_string()) {
      fail(*node, "name must be text in quotation marks");
    }
    // Reports and their files are called by it.
    const std::string& name = **node->as_string();
    const auto legal = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
             c == '_';
    };
    constexpr std::size_t kLongest = 64;
    if (name.empty() || name.size() > kLongest || !std::ranges::all_of(name, legal)) {
      fail(*node, "name must be 1 to 64 letters, digits, hyphens and underscores");
    }
    return name;
  }

  [[nodiscard]] double number(const SensorNumberKey& key, const toml::node& node) const {
    if (!node.is_number() || (key.whole && !node.is_integer())) {
      fail(node, fmt::format("{} must be a {}number", key.name, key.whole ? "whole " : ""));
    }
    // An integer beyond 2^53 has no value<double>(); -0 is 0.
    const double value =
        node.is_integer() ? static_cast<double>(**node.as_integer()) : **node.as_floating_point() + 0.0;
    const std::string text =
        node.is_integer() ? fmt::format("{}", **node.as_integer()) : fmt::format("{}", value);
    if (const std::string error = sensor_number_error(key, value, text); !error.empty()) {
      fail(node, error);
    }
    return value;
  }

  [[nodiscard]] std::optional<std::string> text(std::string_view section, std::string_view key) const {
    const toml::node* node = find(section, key);
    if (node == nullptr) {
      return std::nullopt;
    }
    if (!node->is_string()) {
      fail(*node, fmt::format("{} must be text in quotation marks", key));
    }
    if ((*node->as_string())->empty()) {
      fail(*node, fmt::format("{} is empty; leave the key out if there is none", key));
    }
    return **node->as_string();
  }

  /// Refuses `key` unless what it needs is there.
  void require(std::string_view section, std::string_view key, bool there, std::string_view needs) const {
    const toml::node* node = find(section, key);
    if (node != nullptr && !there) {
      fail(*node, fmt::format("{} needs {}", key, needs));
    }
  }

  /// What `read` makes of a file, its complaints with the line of the key that names the file.
  template <typename Read>
  auto reading(std::string_view section, std::string_view key, const std::filesystem::path& file,
               Read read) const {
    try {
      return read();
    } catch (const InputError& error) {
      const std::string reason = error.what();
      const bool named = reason.starts_with(file.string());
      fail(*find(section, key), fmt::format("{}: {}{}", key, named ? "" : file.string() + ": ", reason));
    }
  }

  [[nodiscard]] std::filesystem::path beside(const std::string& file) const {
    return path_.parent_path() / file;
  }

  void read_response(SensorDraft& draft) const {
    const std::optional<std::string> file = text("laser", "pulse_response_file");
    require("laser", "pulse_response_bin_ps", file.has_value(), "pulse_response_file");
    require("laser", "pulse_response_first_bin", file.has_value(), "pulse_response_file");
    if (!file) {
      return;
    }
    require("laser", "pulse_response_file", draft.response_bin_s > 0.0, "pulse_response_bin_ps");
    draft.model.pulse_response = reading("laser", "pulse_response_file", beside(*file), [&] {
      NpyArray array = read_npy(beside(*file));
      if (array.shape.size() != 1) {
        throw InputError(fmt::format("{} dimensions instead of one", array.shape.size()));
      }
      if (draft.response_first_bin >= static_cast<double>(array.values.size())) {
        throw InputError(fmt::format("{} bins, so pulse_response_first_bin cannot be {}", array.values.size(),
                                     draft.response_first_bin));
      }
      std::rotate(array.values.begin(),
                  array.values.begin() + static_cast<std::ptrdiff_t>(draft.response_first_bin),
                  array.values.end());
      return std::make_shared<const PulseResponse>(std::move(array.values), draft.response_bin_s);
    });
    draft.model.pulse_fwhm_s = draft.model.pulse_response->full_width_at_half_maximum();
  }

  void read_code_widths(SensorModel& model) const {
    const std::optional<std::string> file = text("tdc", "code_widths_file");
    const std::optional<std::string> column = text("tdc", "code_widths_column");
    const std::optional<std::string> row = text("tdc", "code_widths_row");
    for (const std::string_view key : {"code_widths_column", "code_widths_row", "code_widths_are_edges"}) {
      require("tdc", key, file.has_value(), "code_widths_file");
    }
    if (!file) {
      return;
    }
    require("tdc", "code_widths_file", column || row, "either code_widths_column or code_widths_row");
    if (column && row) {
      fail(*find("tdc", "code_widths_row"), "the widths are in code_widths_column, too: give one of the two");
    }
    const toml::node* edges = find("tdc", "code_widths_are_edges");
    if (edges != nullptr && !edges->is_boolean()) {
      fail(*edges, "code_widths_are_edges must be true or false");
    }
    model.tdc_codes = reading("tdc", "code_widths_file", beside(*file), [&] {
      const CsvTable table(beside(*file));
      std::vector<std::vector<double>> widths;
      if (column) {
        widths.push_back(table.column(*column));
      } else if (*row == "all") {
        widths = table.rows();
      } else {
        widths.push_back(table.row(*row));
      }
      if (edges != nullptr && **edges->as_boolean()) {
        for (std::vector<double>& values : widths) {
          std::adjacent_difference(values.begin(), values.end(), values.begin());
        }
      }
      return std::make_shared<const TdcCodes>(std::move(widths));
    });
  }

  void read_detector(SensorModel& model) const {
    PixelDefects& defects = model.defects;
    if (base_ != nullptr && root_.get("detector") == nullptr) {
      return;
    }
    defects.hot = pixels("hot_pixels", model);
    defects.dead = pixels("dead_pixels", model);
    const bool hot = defects.hot_share > 0.0 || !defects.hot.empty();
    require("detector", "hot_pixel_dark_count_rate_hz", hot, "hot_pixel_share above 0 or hot_pixels");
    if (hot && find("detector", "hot_pixel_dark_count_rate_hz") == nullptr) {
      fail_in("detector", "hot pixels need hot_pixel_dark_count_rate_hz");
    }
    require("detector", "defect_seed", defects.hot_share > 0.0 || defects.dead_share > 0.0,
            "hot_pixel_share or dead_pixel_share above 0");
    const bool afterpulsing = model.afterpulse_probability > 0.0;
    require("detector", "afterpulsing_time_constant_ns", afterpulsing, "an afterpulsing_probability above 0");
    require("detector", "afterpulsing_probability", !afterpulsing || model.afterpulse_time_constant_s > 0.0,
            "afterpulsing_time_constant_ns");
  }

  void read_surroundings(Surroundings& around) const {
    TimingSkew& skew = around.skew;
    if (const std::optional<std::string> pattern = text("tdc", "column_skew_pattern")) {
      require("tdc", "column_skew_pattern", skew.column_s > 0.0, "a column_skew_ps above 0");
      if (*pattern == "alternating") {
        skew.pattern = SkewPattern::kAlternating;
      } else if (*pattern == "ramp") {
        skew.pattern = SkewPattern::kRamp;
      } else if (*pattern != "random") {
        fail(*find("tdc", "column_skew_pattern"),
             fmt::format("column_skew_pattern is \"{}\", but must be \"random\", \"ramp\" or \"alternating\"",
                         *pattern));
      }
    }
    require("tdc", "skew_seed",
            (skew.column_s > 0.0 && skew.pattern == SkewPattern::kRandom) || skew.pixel_s > 0.0,
            "a random column_skew_ps or a pixel_skew_ps above 0");
    const LaserSettling& settling = around.settling;
    const bool settles = settling.power_drop != 0.0 || settling.delay_s != 0.0;
    require("laser", "start_up_time_share", settles, "start_up_power_drop or start_up_delay_ps");
    for (const std::string_view key : {"start_up_power_drop", "start_up_delay_ps"}) {
      require("laser", key, !settles || settling.time_share > 0.0, "start_up_time_share");
    }
    const FiringOffsets& offsets = around.firing_offsets;
    require("laser", "firing_offset_step_ns", offsets.bits > 0, "firing_offset_bits above 0");
    require("laser", "firing_offset_seed", offsets.bits > 0, "firing_offset_bits above 0");
    require("laser", "firing_offset_bits", offsets.bits == 0 || offsets.step_s > 0.0,
            "firing_offset_step_ns");
    if (root_.contains("motion") && find("motion", "radial_velocity_m_per_s") == nullptr &&
        find("motion", "columns_per_frame") == nullptr && find("motion", "rows_per_frame") == nullptr) {
      fail_in("motion", "[motion] has no radial_velocity_m_per_s, columns_per_frame or rows_per_frame");
    }
    if (root_.contains("pane") && find("pane", "transmittance") == nullptr) {
      around.pane.transmittance = kClearGlass;
    }
  }

  [[nodiscard]] std::vector<PixelPosition> pixels(std::string_view key, const SensorModel& model) const {
    const toml::node* node = find("detector", key);
    std::vector<PixelPosition> found;
    if (node == nullptr) {
      return found;
    }
    if (!node->is_array()) {
      fail(*node, fmt::format("{} must be a list of [column, row]", key));
    }
    for (const toml::node& element : *node->as_array()) {
      const toml::array* pair = element.as_array();
      const bool two_integers =
          pair != nullptr && pair->size() == 2 && pair->get(0)->is_integer() && pair->get(1)->is_integer();
      if (!two_integers) {
        fail(element, fmt::format("{} must be a list of [column, row]", key));
      }
      const std::int64_t column = **pair->get(0)->as_integer();
      const std::int64_t row = **pair->get(1)->as_integer();
      if (column < 0 || column >= model.columns || row < 0 || row >= model.rows) {
        fail(element, fmt::format("{}: pixel [{}, {}] is outside the array of {} x {}", key, column, row,
                                  model.columns, model.rows));
      }
      found.push_back({static_cast<int>(column), static_cast<int>(row)});
    }
    return found;
  }

  /// One pixel is one SPAD.
  static void apply_optics(SensorDraft& draft) {
    SensorModel& model = draft.model;
    OpticalInputs& optics = draft.optics;
    optics.pulse_fwhm_s = model.pulse_fwhm_s;
    optics.integration_time_s = model.integration_time_s;
    optics.spad_count = static_cast<double>(model.columns) * model.rows;
    optics.afov_deg = model.degrees_per_pixel();
    model.signal_events_1m = signal_events_per_pulse(optics, 1.0, 1.0);
    model.background_events_per_klux = sunlight_events_per_window(optics, 1.0, 1.0);
  }

  const toml::table& root_;
  std::filesystem::path path_;
  const SensorModel* base_;
};

}  // namespace

SensorModel parse_sensor(std::string_view toml, const std::filesystem::path& path) {
  try {
    return SensorReader(toml::parse(toml, path.string()), path).read();
  } catch (const toml::parse_error& error) {
    fail_at_line(path.string(), error.source().begin.line, fmt::format("no TOML: {}", error.description()));
  }
}

SensorModel change_sensor(const SensorModel& sensor, std::string_view toml,
                          const std::filesystem::path& path) {
  try {
    return SensorReader(toml::parse(toml, path.string()), path, &sensor).read();
  } catch (const toml::parse_error& error) {
    fail_at_line(path.string(), error.source().begin.line, fmt::format("no TOML: {}", error.description()));
  }
}

SensorModel read_sensor_file(const std::filesystem::path& path) {
  return parse_sensor(read_file(path), path);
}

}  // namespace dtof
