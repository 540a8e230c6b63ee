// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/sensor_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/suggestion.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/photon/physics.hpp"

namespace dtof {
namespace {

/// What a file describes, before the rates that follow from its optics are computed.
struct Draft {
  SensorModel model;
  OpticalInputs optics;
  double response_bin_s = 0.0;
  double response_first_bin = 0.0;
};

enum class Need {
  kAlways,
  kWithoutOptics,
  kWithOptics,
  kWithoutResponse,
  kWithSection,  ///< whenever the file has the key's section
  kNever,        ///< the default stands
};

/// A number of the file. Units are those of the key's name; dividing by a power of ten, which a double holds
/// exactly, gives the double nearest to the decimal number in SI units.
struct NumberKey {
  std::string_view section;
  std::string_view name;
  Need need;
  double lowest;
  bool lowest_allowed;
  double highest;
  bool whole;
  void (*set)(Draft& draft, double value);
  std::string_view default_text;
  std::string_view meaning;
  std::string_view reason;  ///< of the limits
};

constexpr bool kIncluded = true;
constexpr bool kExcluded = false;
constexpr bool kWhole = true;
constexpr bool kReal = false;
constexpr double kClearGlass = 0.92;
constexpr double kMicro = 1e6;
constexpr double kNano = 1e9;
constexpr double kPico = 1e12;

constexpr auto kNumbers = std::to_array<NumberKey>({
    {"array", "columns", Need::kNever, 1, kIncluded, 4096, kWhole,
     [](Draft& d, double v) { d.model.columns = static_cast<int>(v); }, "200", "columns of the array",
     "larger arrays are described by a part of them"},
    {"array", "rows", Need::kNever, 1, kIncluded, 4096, kWhole,
     [](Draft& d, double v) { d.model.rows = static_cast<int>(v); }, "160", "rows of the array",
     "larger arrays are described by a part of them"},
    {"array", "field_of_view_deg", Need::kNever, 0, kExcluded, 180, kReal,
     [](Draft& d, double v) { d.model.field_of_view_deg = v; }, "96",
     "field of view over all columns; every pixel sees the same angle",
     "one lens sees less than half of space"},
    {"tdc", "range_ns", Need::kAlways, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.integration_time_s = v / kNano; }, "",
     "T_int, the time that the codes span", "1e6 ns are 150 km"},
    {"tdc", "timestamp_bits", Need::kNever, 3, kIncluded, 16, kWhole,
     [](Draft& d, double v) { d.model.np = static_cast<int>(v); }, "10", "NP, bits of a timestamp",
     "the read-outs' own limits"},
    {"tdc", "slots", Need::kNever, 1, kIncluded, 16, kWhole,
     [](Draft& d, double v) { d.model.slots = static_cast<int>(v); }, "2",
     "SLOTS, events that the TDC keeps per acquisition", "the bound on accuracy is computed for up to 16"},
    {"tdc", "column_skew_ps", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.skew.column_s = v / kPico; }, "0",
     "delay of a column's timestamps is between minus and plus this, by column_skew_pattern",
     "a microsecond is longer than any range of interest"},
    {"tdc", "pixel_skew_ps", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.skew.pixel_s = v / kPico; }, "0",
     "delay of each pixel's timestamps, uniform between minus and plus this; adds to its column's",
     "a microsecond is longer than any range of interest"},
    {"tdc", "skew_seed", Need::kNever, 0, kIncluded, 4294967295.0, kWhole,
     [](Draft& d, double v) { d.model.surroundings.skew.seed = static_cast<std::uint64_t>(v); }, "1",
     "which skew a column and a pixel have; the same in every frame", "32 bits"},
    {"laser", "acquisitions", Need::kAlways, 1, kIncluded, 1048575, kWhole,
     [](Draft& d, double v) { d.model.acquisitions = static_cast<std::uint32_t>(v); }, "",
     "laser pulses of a frame", "the detections of a frame's columns are held in memory"},
    {"laser", "pulse_fwhm_ns", Need::kWithoutResponse, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.pulse_fwhm_s = v / kNano; }, "",
     "full width at half maximum of the Gaussian pulse", "a pulse is shorter than the range"},
    {"laser", "pulse_response_bin_ps", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.response_bin_s = v / kPico; }, "required with the file",
     "bin width of the measured response", "a microsecond is longer than any pulse"},
    {"laser", "pulse_response_first_bin", Need::kNever, 0, kIncluded, 999'999, kWhole,
     [](Draft& d, double v) { d.response_first_bin = v; }, "0",
     "the bin that the response begins with; those before it follow the last, as in a record of one laser "
     "period",
     "a bin of the record"},
    {"laser", "pulse_period_us", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.pulse_period_s = v / kMicro; }, "1e6 / 30 / acquisitions",
     "from pulse to pulse; decides how far targets and another laser's pulses move",
     "a second is longer than any frame"},
    {"laser", "start_up_silent_share", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.silent_share = v; }, "0",
     "share of the frame at its begin in which the laser sends nothing", "a share"},
    {"laser", "start_up_power_drop", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.power_drop = v; }, "0",
     "the first pulse has 1 minus this of the settled power, which is reached exponentially", "a share"},
    {"laser", "start_up_delay_ps", Need::kNever, -1e6, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.delay_s = v / kPico; }, "0",
     "how much later the first pulse is than the settled ones; falls exponentially",
     "a microsecond is longer than any range of interest"},
    {"laser", "start_up_time_share", Need::kNever, 0, kExcluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.time_share = v; }, "required with the two before",
     "time constant of both over the frame's length", "longer ones change nothing within a frame"},
    {"laser", "power_drift", Need::kNever, -2, kIncluded, 2, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.power_drift = v; }, "0",
     "power at the frame's end minus that at its begin, over the mean; linear",
     "with more, the laser would have less than no power"},
    {"laser", "firing_offset_bits", Need::kNever, 0, kIncluded, 12, kWhole,
     [](Draft& d, double v) { d.model.surroundings.firing_offsets.bits = static_cast<int>(v); }, "0 (none)",
     "shot and start of the TDC are delayed together by a pseudo-random number of steps, 0 to 2^bits - 1: "
     "only the other laser's pulses move",
     "more would take a large part of the frame"},
    {"laser", "firing_offset_step_ns", Need::kNever, 0, kExcluded, 1000, kReal,
     [](Draft& d, double v) { d.model.surroundings.firing_offsets.step_s = v / kNano; },
     "required with the bits", "step of the firing offsets, a clock of the sensor", "a clock"},
    {"laser", "firing_offset_seed", Need::kNever, 1, kIncluded, 65535, kWhole,
     [](Draft& d, double v) { d.model.surroundings.firing_offsets.seed = static_cast<std::uint16_t>(v); },
     "1", "start of the shift register of 16 bits, the same in every frame",
     "the register holds 16 bits, not all 0"},
    {"light", "signal_events_at_1m", Need::kWithoutOptics, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.signal_events_1m = v; }, "",
     "detected events of a pixel and pulse from a target of reflectivity 1 at 1 m; falls with the distance "
     "squared",
     "a TDC keeps a few events of a pulse"},
    {"light", "background_events_per_klux", Need::kWithoutOptics, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.background_events_per_klux = v; }, "",
     "detected events of a pixel and range from sunlight on a target of reflectivity 1, without dark counts",
     "a TDC keeps a few events of a pulse"},
    {"light", "default_reflectivity", Need::kNever, 0, kIncluded, 4, kReal,
     [](Draft& d, double v) { d.model.default_reflectivity = v; }, "1", "of scenes that do not say their own",
     "a white matt surface is 1, a glint is more, and the photon models are checked up to 4"},
    {"optics", "peak_power_w", Need::kWithOptics, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.optics.peak_power_w = v; }, "",
     "laser power at the pulse's peak, shared by all pixels", "no eye-safe laser is near the limit"},
    {"optics", "wavelength_nm", Need::kWithOptics, 200, kIncluded, 2000, kReal,
     [](Draft& d, double v) { d.optics.wavelength_m = v / kNano; }, "", "of the laser",
     "SPADs of silicon, germanium and InGaAs"},
    {"optics", "lens_area_mm2", Need::kWithOptics, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.optics.lens_area_m2 = v / 1e6; }, "", "aperture of the lens, pi D^2 / 4",
     "1e6 mm2 are a lens of more than a metre"},
    {"optics", "lens_efficiency", Need::kWithOptics, 0, kExcluded, 1, kReal,
     [](Draft& d, double v) { d.optics.lens_efficiency = v; }, "",
     "share of the light that passes lens and filter", "a share"},
    {"optics", "photon_detection_efficiency", Need::kWithOptics, 0, kExcluded, 1, kReal,
     [](Draft& d, double v) { d.optics.pde = v; }, "", "PDE, fill factor included", "a share"},
    {"optics", "filter_width_nm", Need::kWithOptics, 0, kExcluded, 1000, kReal,
     [](Draft& d, double v) { d.optics.filter_width_nm = v; }, "", "pass band before the sensor",
     "wider than all that silicon sees"},
    {"optics", "solar_irradiance_mw_per_m2_nm_klux", Need::kWithOptics, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.optics.solar_irradiance = v; }, "",
     "sunlight on the target at the wavelength (ASTM G173: 850 nm 8.9, 905 nm 6.3, 940 nm 2.8)",
     "the sun's largest is below 20"},
    {"detector", "dark_count_rate_hz", Need::kNever, 0, kIncluded, 1e9, kReal,
     [](Draft& d, double v) { d.model.dark_count_rate_hz = v; }, "0", "DCR of a pixel",
     "no SPAD recharges faster"},
    {"detector", "dead_time_ns", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.dead_time_s = v / kNano; }, "0 (none)",
     "after a counted event of the pixel none counts; not paralysable; over with the acquisition",
     "it is over with the acquisition"},
    {"detector", "jitter_fwhm_ps", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.jitter_fwhm_s = v / kPico; }, "0 (none)",
     "full width at half maximum of the detector's normal timing error; added to the pulse's width in "
     "quadrature",
     "a microsecond is longer than any jitter"},
    {"detector", "afterpulsing_probability", Need::kNever, 0, kIncluded, 0.9, kReal,
     [](Draft& d, double v) { d.model.afterpulse_probability = v; }, "0 (none)",
     "that a counted event is followed by another one behind the dead time",
     "above, a pixel fires nearly without end"},
    {"detector", "afterpulsing_time_constant_ns", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.afterpulse_time_constant_s = v / kNano; },
     "required with the probability", "mean time from the dead time's end to the afterpulse, exponential",
     "longer ones reach another acquisition"},
    {"detector", "hot_pixel_share", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.defects.hot_share = v; }, "0", "share of the pixels that are hot",
     "a share"},
    {"detector", "hot_pixel_dark_count_rate_hz", Need::kNever, 0, kIncluded, 1e9, kReal,
     [](Draft& d, double v) { d.model.defects.hot_dark_count_rate_hz = v; }, "required with hot pixels",
     "DCR of a hot pixel", "no SPAD recharges faster"},
    {"detector", "dead_pixel_share", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.defects.dead_share = v; }, "0", "share of the pixels that see nothing",
     "a share"},
    {"detector", "defect_seed", Need::kNever, 0, kIncluded, 4294967295.0, kWhole,
     [](Draft& d, double v) { d.model.defects.seed = static_cast<std::uint64_t>(v); }, "1",
     "which pixels the shares choose; the same in every frame", "32 bits"},
    {"cover_glass", "crosstalk_events", Need::kWithSection, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.cover_glass.events = v; }, "",
     "detected events of a pixel and pulse that the cover glass before the sensor scatters into it: an early "
     "return "
     "that is the same in every pixel",
     "a TDC keeps a few events of a pulse"},
    {"cover_glass", "distance_m", Need::kNever, 0, kIncluded, 10, kReal,
     [](Draft& d, double v) { d.model.surroundings.cover_glass.distance_m = v; }, "0.03", "of the glass",
     "a cover glass is a part of the sensor"},
    {"fog", "extinction_per_m", Need::kWithSection, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.fog.extinction_per_m = v; }, "",
     "alpha of a homogeneous medium (fog, smoke, dust): a target at R keeps exp(-2 alpha R) of its signal; "
     "the "
     "visibility is 3.9 / alpha (Koschmieder)",
     "nothing returns through more"},
    {"fog", "lidar_ratio_sr", Need::kNever, 0, kExcluded, 1000, kReal,
     [](Draft& d, double v) { d.model.surroundings.fog.lidar_ratio_sr = v; }, "18.8",
     "extinction over backscatter: about 19 sr for water droplets (O'Connor et al. 2004), 50 to 80 for smoke",
     "no aerosol's is near the limit"},
    {"fog", "overlap_m", Need::kNever, 0, kExcluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.fog.overlap_m = v; }, "0.1",
     "distance from which on a pixel sees what the laser lights; nearer fog returns nothing",
     "an overlap beyond 100 m has no use"},
    {"pane", "distance_m", Need::kWithSection, 0, kExcluded, 1e5, kReal,
     [](Draft& d, double v) { d.model.surroundings.pane.distance_m = v; }, "",
     "of a pane across the scene: another return before all that is behind it",
     "150 km are the longest range"},
    {"pane", "reflectivity", Need::kWithSection, 0, kIncluded, 4, kReal,
     [](Draft& d, double v) { d.model.surroundings.pane.reflectivity = v; }, "",
     "of the pane as a matt surface, by its dust; a mirror's glint is more", "as that of a target"},
    {"pane", "transmittance", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.surroundings.pane.transmittance = v; }, "0.92",
     "share of the light that passes once: signal from behind passes twice, its sunlight once (0.92: two "
     "surfaces "
     "of clear glass)",
     "a share"},
    {"other_laser", "events", Need::kWithSection, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.events = v; }, "",
     "detected events of a pixel and pulse of another sensor's laser, the same in every pixel",
     "a TDC keeps a few events of a pulse"},
    {"other_laser", "rate_offset_ppm", Need::kNever, -1e5, kIncluded, 1e5, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.rate_offset = v / 1e6; }, "0",
     "how much faster it fires than the sensor's own laser; its pulses then arrive earlier from acquisition "
     "to "
     "acquisition",
     "a tenth is another rate"},
    {"other_laser", "first_arrival_ns", Need::kNever, -1e9, kIncluded, 1e9, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.first_arrival_s = v / kNano; }, "0",
     "phase: when its first pulse arrives after the frame's begin; pulses come before it, too",
     "a second is longer than any frame"},
    {"other_laser", "pulse_fwhm_ns", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.pulse_fwhm_s = v / kNano; },
     "that of the sensor's own", "full width at half maximum of its Gaussian pulse",
     "a pulse is shorter than the range"},
    {"motion", "radial_velocity_m_per_s", Need::kNever, -1e4, kIncluded, 1e4, kReal,
     [](Draft& d, double v) { d.model.surroundings.motion.velocity_m_per_s = v; }, "0",
     "of every target along its pixel's ray during the frame, above 0: away; its distance is that at the "
     "frame's "
     "middle",
     "faster than a bullet"},
    {"motion", "columns_per_frame", Need::kNever, -1e3, kIncluded, 1e3, kReal,
     [](Draft& d, double v) { d.model.surroundings.lateral.columns_per_frame = v; }, "0",
     "how many of its columns the camera moves to the right during the frame, below 0: to the left; at the "
     "frame's middle each pixel sees its own pixel of the scene",
     "longer ways are several frames"},
    {"motion", "rows_per_frame", Need::kNever, -1e3, kIncluded, 1e3, kReal,
     [](Draft& d, double v) { d.model.surroundings.lateral.rows_per_frame = v; }, "0",
     "how many of its rows the camera moves down during the frame, below 0: up",
     "longer ways are several frames"},
});

/// A key that is no number.
struct OtherKey {
  std::string_view section;
  std::string_view name;
  std::string_view type;
  std::string_view default_text;
  std::string_view meaning;
};

constexpr auto kOthers = std::to_array<OtherKey>({
    {"tdc", "code_widths_file", "path", "none: equal codes",
     "CSV, plain or gzip, of measured TDC code widths (differential non-linearity), in any unit: they repeat "
     "until all "
     "2^NP codes have one and are scaled so that the codes fill the range; widths of 0 at both ends of the "
     "list are "
     "taps that are not reached and are left out"},
    {"tdc", "code_widths_column", "text", "this or the next is required with the file",
     "name, in the file's first line, of the column that holds the widths"},
    {"tdc", "code_widths_row", "text", "",
     "first field of the line that holds the widths, or \"all\": each line is another TDC, and pixel row * "
     "columns + "
     "column has line number (that modulo their number); empty lines do not count"},
    {"tdc", "code_widths_are_edges", "true or false", "false",
     "the file holds the upper edges of the codes, ascending, instead of their widths"},
    {"tdc", "column_skew_pattern", "\"random\", \"ramp\" or \"alternating\"", "\"random\"",
     "random: each column by itself, uniform between minus and plus; ramp: from minus at the first column to "
     "plus at "
     "the last; alternating: even columns plus, odd ones minus"},
    {"laser", "pulse_response_file", "path", "none: a Gaussian of pulse_fwhm_ns",
     "NPY with the measured pulse, one dimension, in proportion to its density; its centroid arrives one "
     "FWHM after "
     "2R/c, as the Gaussian's does"},
    {"detector", "hot_pixels", "list of [column, row]", "[]", "pixels that are hot besides the share"},
    {"detector", "dead_pixels", "list of [column, row]", "[]", "pixels that are dead besides the share"},
});

constexpr auto kSections =
    std::to_array<std::string_view>({"array", "tdc", "laser", "light", "optics", "detector", "cover_glass",
                                     "fog", "pane", "other_laser", "motion"});

std::vector<std::string_view> keys_of(std::string_view section) {
  std::vector<std::string_view> names;
  for (const NumberKey& key : kNumbers) {
    if (key.section == section) {
      names.push_back(key.name);
    }
  }
  for (const OtherKey& key : kOthers) {
    if (key.section == section) {
      names.push_back(key.name);
    }
  }
  return names;
}

std::string limits(const NumberKey& key) {
  return key.lowest_allowed ? fmt::format("{} to {}", key.lowest, key.highest)
                            : fmt::format("above {} to {}", key.lowest, key.highest);
}

std::string_view default_of(const NumberKey& key) {
  switch (key.need) {
    case Need::kAlways:
    case Need::kWithOptics:
    case Need::kWithSection:
      return "required";
    case Need::kWithoutOptics:
      return "required without [optics]";
    case Need::kWithoutResponse:
      return "required without pulse_response_file";
    case Need::kNever:
      return key.default_text;
  }
  throw std::logic_error("no such need");
}

class SensorReader {
 public:
  /// `base`: what the file changes; none: the file says all.
  SensorReader(const toml::table& root, std::filesystem::path path, const SensorModel* base = nullptr)
      : root_(root), path_(std::move(path)), base_(base) {}

  SensorModel read() {
    check_names();
    Draft draft;
    if (base_ != nullptr) {
      draft.model = *base_;
    } else {
      draft.model.dark_count_rate_hz = 0.0;
      draft.model.name = read_name();
    }
    const bool optics = root_.contains("optics");
    const bool response = find("laser", "pulse_response_file") != nullptr;
    for (const NumberKey& key : kNumbers) {
      const toml::node* node = find(key.section, key.name);
      if (node != nullptr) {
        if (optics && key.need == Need::kWithoutOptics) {
          fail(*node, fmt::format("{} follows from [optics]: give one of the two", key.name));
        }
        if (response && key.need == Need::kWithoutResponse) {
          fail(*node, fmt::format("{} follows from pulse_response_file: give one of the two", key.name));
        }
        key.set(draft, number(key, *node));
      } else if (base_ != nullptr && key.need != Need::kWithSection) {
        continue;
      } else if (key.need == Need::kAlways ||
                 key.need == (optics ? Need::kWithOptics : Need::kWithoutOptics) ||
                 (key.need == Need::kWithoutResponse && !response) ||
                 (key.need == Need::kWithSection && root_.contains(key.section))) {
        fail_in(key.section, fmt::format("[{}] has no {} ({})", key.section, key.name, key.meaning));
      }
    }
    read_response(draft);
    if (optics) {
      apply_optics(draft);
    }
    if (draft.model.pulse_fwhm_s >= draft.model.integration_time_s) {
      fail_in("laser", fmt::format("a pulse of {:g} ns does not fit into a range of {:g} ns",
                                   draft.model.pulse_fwhm_s * kNano, draft.model.integration_time_s * kNano));
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
      if (std::ranges::find(kSections, name.str()) == std::end(kSections)) {
        std::vector<std::string_view> known(std::begin(kSections), std::end(kSections));
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
    const std::vector<std::string_view> known = keys_of(section);
    for (const auto& [name, node] : table) {
      if (std::ranges::find(known, name.str()) != known.end()) {
        continue;
      }
      for (const std::string_view other : kSections) {
        const std::vector<std::string_view> keys = keys_of(other);
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

  [[nodiscard]] double number(const NumberKey& key, const toml::node& node) const {
    if (!node.is_number() || (key.whole && !node.is_integer())) {
      fail(node, fmt::format("{} must be a {}number", key.name, key.whole ? "whole " : ""));
    }
    const double value = *node.value<double>() + 0.0;  // -0 is 0
    const bool high_enough = key.lowest_allowed ? value >= key.lowest : value > key.lowest;
    // Written so that a NaN fails.
    if (!(high_enough && value <= key.highest)) {
      fail(node, fmt::format("{} is {:g}, but must be {} ({})", key.name, value, limits(key), key.reason));
    }
    return value;
  }

  [[nodiscard]] std::optional<std::string> text(std::string_view section, std::string_view key) const {
    const toml::node* node = find(section, key);
    if (node == nullptr) {
      return std::nullopt;
    }
    if (!node->is_string() || (*node->as_string())->empty()) {
      fail(*node, fmt::format("{} must be text in quotation marks", key));
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
  auto reading(std::string_view section, std::string_view key, Read read) const {
    try {
      return read();
    } catch (const InputError& error) {
      fail(*find(section, key), fmt::format("{}: {}", key, error.what()));
    }
  }

  [[nodiscard]] std::filesystem::path beside(const std::string& file) const {
    return path_.parent_path() / file;
  }

  void read_response(Draft& draft) const {
    const std::optional<std::string> file = text("laser", "pulse_response_file");
    require("laser", "pulse_response_bin_ps", file.has_value(), "pulse_response_file");
    require("laser", "pulse_response_first_bin", file.has_value(), "pulse_response_file");
    if (!file) {
      return;
    }
    require("laser", "pulse_response_file", draft.response_bin_s > 0.0, "pulse_response_bin_ps");
    draft.model.pulse_response = reading("laser", "pulse_response_file", [&] {
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
    require("tdc", "code_widths_file", column.has_value() != row.has_value(),
            "either code_widths_column or code_widths_row");
    const toml::node* edges = find("tdc", "code_widths_are_edges");
    if (edges != nullptr && !edges->is_boolean()) {
      fail(*edges, "code_widths_are_edges must be true or false");
    }
    model.tdc_codes = reading("tdc", "code_widths_file", [&] {
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
  static void apply_optics(Draft& draft) {
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

std::string sensor_key_table() {
  std::string table = "| key | default | limits | meaning |\n|---|---|---|---|\n";
  for (const std::string_view section : kSections) {
    table += fmt::format("| **[{}]** | | | |\n", section);
    for (const NumberKey& key : kNumbers) {
      if (key.section == section) {
        table += fmt::format("| `{}` | {} | {}: {} | {} |\n", key.name, default_of(key), limits(key),
                             key.reason, key.meaning);
      }
    }
    for (const OtherKey& key : kOthers) {
      if (key.section == section) {
        table += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.default_text, key.type, key.meaning);
      }
    }
  }
  return table;
}

}  // namespace dtof
