// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/sensor_keys.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

using Draft = SensorDraft;
using Need = SensorKeyNeed;

constexpr bool kIncluded = true;
constexpr bool kExcluded = false;
constexpr bool kWhole = true;
constexpr bool kReal = false;
constexpr double kMicro = 1e6;
constexpr double kNano = 1e9;
constexpr double kPico = 1e12;

constexpr auto kNumbers = std::to_array<SensorNumberKey>({
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

constexpr auto kOthers = std::to_array<SensorOtherKey>({
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

std::string_view default_of(const SensorNumberKey& key) {
  switch (key.need) {
    case SensorKeyNeed::kAlways:
    case SensorKeyNeed::kWithOptics:
    case SensorKeyNeed::kWithSection:
      return "required";
    case SensorKeyNeed::kWithoutOptics:
      return "required without [optics]";
    case SensorKeyNeed::kWithoutResponse:
      return "required without pulse_response_file";
    case SensorKeyNeed::kNever:
      return key.default_text;
  }
  throw std::logic_error("no such need");
}

}  // namespace

std::span<const SensorNumberKey> sensor_number_keys() { return kNumbers; }

std::span<const SensorOtherKey> sensor_other_keys() { return kOthers; }

std::span<const std::string_view> sensor_sections() { return kSections; }

std::vector<std::string_view> sensor_keys_of(std::string_view section) {
  std::vector<std::string_view> names;
  for (const SensorNumberKey& key : kNumbers) {
    if (key.section == section) {
      names.push_back(key.name);
    }
  }
  for (const SensorOtherKey& key : kOthers) {
    if (key.section == section) {
      names.push_back(key.name);
    }
  }
  return names;
}

std::string sensor_key_limits(const SensorNumberKey& key) {
  return key.lowest_allowed ? fmt::format("{} to {}", key.lowest, key.highest)
                            : fmt::format("above {} to {}", key.lowest, key.highest);
}

std::string sensor_key_table() {
  std::string table = "| key | default | limits | meaning |\n|---|---|---|---|\n";
  for (const std::string_view section : kSections) {
    table += fmt::format("| **[{}]** | | | |\n", section);
    for (const SensorNumberKey& key : kNumbers) {
      if (key.section == section) {
        table += fmt::format("| `{}` | {} | {}: {} | {} |\n", key.name, default_of(key),
                             sensor_key_limits(key), key.reason, key.meaning);
      }
    }
    for (const SensorOtherKey& key : kOthers) {
      if (key.section == section) {
        table += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.default_text, key.type, key.meaning);
      }
    }
  }
  return table;
}

}  // namespace dtof
