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
     "describe a larger array by a part of it"},
    {"array", "rows", Need::kNever, 1, kIncluded, 4096, kWhole,
     [](Draft& d, double v) { d.model.rows = static_cast<int>(v); }, "160", "rows of the array",
     "describe a larger array by a part of it"},
    {"array", "field_of_view_deg", Need::kNever, 0, kExcluded, 180, kReal,
     [](Draft& d, double v) { d.model.field_of_view_deg = v; }, "96",
     "angle that all columns together see; each pixel sees the same angle",
     "a lens sees less than 180 degrees"},
    {"tdc", "range_ns", Need::kAlways, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.integration_time_s = v / kNano; }, "",
     "T_int, the time that all codes of a timestamp span", "1e6 ns are 150 km"},
    {"tdc", "timestamp_bits", Need::kNever, 3, kIncluded, 16, kWhole,
     [](Draft& d, double v) { d.model.np = static_cast<int>(v); }, "10", "NP, bits of a timestamp",
     "the limits of the read-outs"},
    {"tdc", "slots", Need::kNever, 1, kIncluded, 16, kWhole,
     [](Draft& d, double v) { d.model.slots = static_cast<int>(v); }, "2",
     "SLOTS, the number of events that the TDC keeps in an acquisition",
     "the bound on accuracy is computed for up to 16"},
    {"tdc", "column_skew_ps", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.skew.column_s = v / kPico; }, "0",
     "largest delay of a column's timestamps: each column's delay lies between minus and plus this value, by "
     "column_skew_pattern",
     "a microsecond is longer than any range of interest"},
    {"tdc", "pixel_skew_ps", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.skew.pixel_s = v / kPico; }, "0",
     "largest delay of a pixel's timestamps: uniform between minus and plus this value; adds to the delay of "
     "the column",
     "a microsecond is longer than any range of interest"},
    {"tdc", "skew_seed", Need::kNever, 0, kIncluded, 4294967295.0, kWhole,
     [](Draft& d, double v) { d.model.surroundings.skew.seed = static_cast<std::uint64_t>(v); }, "1",
     "seed of the skews of columns and pixels, which are the same in every frame", "32 bits"},
    {"laser", "acquisitions", Need::kAlways, 1, kIncluded, 1048575, kWhole,
     [](Draft& d, double v) { d.model.acquisitions = static_cast<std::uint32_t>(v); }, "",
     "laser pulses of a frame", "the memory of the program must hold the detections of a column"},
    {"laser", "pulse_fwhm_ns", Need::kWithoutResponse, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.pulse_fwhm_s = v / kNano; }, "",
     "full width at half maximum of the Gaussian pulse", "a pulse is shorter than the range"},
    {"laser", "pulse_response_bin_ps", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.response_bin_s = v / kPico; }, "required with the file",
     "bin width of the measured response", "a microsecond is longer than any pulse"},
    {"laser", "pulse_response_first_bin", Need::kNever, 0, kIncluded, 999'999, kWhole,
     [](Draft& d, double v) { d.response_first_bin = v; }, "0",
     "bin of the record at which the response begins; the bins before it follow after the last one, as in a "
     "record of one laser period",
     "the largest record has 1,000,000 bins"},
    {"laser", "pulse_period_us", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.pulse_period_s = v / kMicro; }, "1e6 / 30 / acquisitions",
     "time from pulse to pulse; decides how far targets and the pulses of another laser move between "
     "acquisitions",
     "a second is longer than any frame"},
    {"laser", "start_up_silent_share", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.silent_share = v; }, "0",
     "share of the frame, from its begin on, in which the laser sends no pulse", "a share"},
    {"laser", "start_up_power_drop", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.power_drop = v; }, "0",
     "power that the first pulse lacks, as a share of the settled power; falls exponentially", "a share"},
    {"laser", "start_up_delay_ps", Need::kNever, -1e6, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.delay_s = v / kPico; }, "0",
     "delay of the first pulse beyond that of a settled pulse; falls exponentially",
     "a microsecond is longer than any range of interest"},
    {"laser", "start_up_time_share", Need::kNever, 0, kExcluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.time_share = v; }, "required with the two before",
     "time constant of power drop and delay, as a share of the frame",
     "a longer one changes nothing within a frame"},
    {"laser", "power_drift", Need::kNever, -2, kIncluded, 2, kReal,
     [](Draft& d, double v) { d.model.surroundings.settling.power_drift = v; }, "0",
     "linear drift: power at the end of the frame minus power at its begin, as a share of the mean power",
     "beyond, the power would be negative"},
    {"laser", "firing_offset_bits", Need::kNever, 0, kIncluded, 12, kWhole,
     [](Draft& d, double v) { d.model.surroundings.firing_offsets.bits = static_cast<int>(v); }, "0 (none)",
     "shot and start of the TDC are delayed together by a pseudo-random number of steps from 0 to 2^bits - "
     "1, so that only the pulses of another laser move",
     "longer offsets would take a large part of the frame"},
    {"laser", "firing_offset_step_ns", Need::kNever, 0, kExcluded, 1000, kReal,
     [](Draft& d, double v) { d.model.surroundings.firing_offsets.step_s = v / kNano; },
     "required with the bits", "step of the firing offsets: a clock of the sensor",
     "a clock of at least 1 MHz"},
    {"laser", "firing_offset_seed", Need::kNever, 1, kIncluded, 65535, kWhole,
     [](Draft& d, double v) { d.model.surroundings.firing_offsets.seed = static_cast<std::uint16_t>(v); },
     "1", "first state of the shift register of 16 bits, the same in every frame",
     "the register has 16 bits, and stops if all are 0"},
    {"light", "signal_events_at_1m", Need::kWithoutOptics, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.signal_events_1m = v; }, "",
     "events that a pixel detects for each pulse from a target of reflectivity 1 at 1 m; falls with the "
     "square of the distance",
     "a TDC keeps a few events of a pulse"},
    {"light", "background_events_per_klux", Need::kWithoutOptics, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.background_events_per_klux = v; }, "",
     "events that a pixel detects in one range from sunlight of 1 klux on a target of reflectivity 1, "
     "without dark counts",
     "a TDC keeps a few events of a pulse"},
    {"light", "default_reflectivity", Need::kNever, 0, kIncluded, 4, kReal,
     [](Draft& d, double v) { d.model.default_reflectivity = v; }, "1",
     "reflectivity of scenes that have none of their own",
     "a white matt surface is 1, a glint is more, and the photon models are checked up to 4"},
    {"optics", "peak_power_w", Need::kWithOptics, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.optics.peak_power_w = v; }, "",
     "laser power at the pulse's peak, shared by all pixels", "no eye-safe laser is near the limit"},
    {"optics", "wavelength_nm", Need::kWithOptics, 200, kIncluded, 2000, kReal,
     [](Draft& d, double v) { d.optics.wavelength_m = v / kNano; }, "", "wavelength of the laser",
     "SPADs of silicon, germanium and InGaAs detect no others"},
    {"optics", "lens_area_mm2", Need::kWithOptics, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.optics.lens_area_m2 = v / 1e6; }, "",
     "area of the lens's aperture, pi D^2 / 4", "1e6 mm2 are a lens of more than a metre"},
    {"optics", "lens_efficiency", Need::kWithOptics, 0, kExcluded, 1, kReal,
     [](Draft& d, double v) { d.optics.lens_efficiency = v; }, "",
     "share of the light that passes lens and filter", "a share"},
    {"optics", "photon_detection_efficiency", Need::kWithOptics, 0, kExcluded, 1, kReal,
     [](Draft& d, double v) { d.optics.pde = v; }, "",
     "PDE: share of the photons on a pixel that are detected, fill factor included", "a share"},
    {"optics", "filter_width_nm", Need::kWithOptics, 0, kExcluded, 1000, kReal,
     [](Draft& d, double v) { d.optics.filter_width_nm = v; }, "", "width of the optical filter's pass band",
     "silicon detects no wider band"},
    {"optics", "solar_irradiance_mw_per_m2_nm_klux", Need::kWithOptics, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.optics.solar_irradiance = v; }, "",
     "sunlight on the target at the wavelength of the laser (ASTM G173: 850 nm 8.9, 905 nm 6.3, 940 nm 2.8)",
     "the largest value of the sun's spectrum is below 20"},
    {"detector", "dark_count_rate_hz", Need::kNever, 0, kIncluded, 1e9, kReal,
     [](Draft& d, double v) { d.model.dark_count_rate_hz = v; }, "0",
     "DCR: rate of the events of a pixel in the dark", "no SPAD recharges faster"},
    {"detector", "dead_time_ns", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.dead_time_s = v / kNano; }, "0 (none)",
     "time after a counted event in which no event of the pixel counts; not paralysable; ends with the "
     "acquisition",
     "it ends with the acquisition"},
    {"detector", "jitter_fwhm_ps", Need::kNever, 0, kIncluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.jitter_fwhm_s = v / kPico; }, "0 (none)",
     "full width at half maximum of the detector's timing error, which is normal; its square is added to "
     "that of the pulse's width",
     "a microsecond is longer than any jitter"},
    {"detector", "afterpulsing_probability", Need::kNever, 0, kIncluded, 0.9, kReal,
     [](Draft& d, double v) { d.model.afterpulse_probability = v; }, "0 (none)",
     "probability that an afterpulse follows a counted event, after the dead time",
     "with a larger one a pixel fires nearly without end"},
    {"detector", "afterpulsing_time_constant_ns", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.afterpulse_time_constant_s = v / kNano; },
     "required with the probability",
     "mean time from the end of the dead time to the afterpulse, exponential",
     "after a longer time the acquisition has ended"},
    {"detector", "hot_pixel_share", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.defects.hot_share = v; }, "0", "share of the pixels that are hot",
     "a share"},
    {"detector", "hot_pixel_dark_count_rate_hz", Need::kNever, 0, kIncluded, 1e9, kReal,
     [](Draft& d, double v) { d.model.defects.hot_dark_count_rate_hz = v; }, "required with hot pixels",
     "DCR of a hot pixel", "no SPAD recharges faster"},
    {"detector", "dead_pixel_share", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.defects.dead_share = v; }, "0",
     "share of the pixels that are dead: they detect nothing", "a share"},
    {"detector", "defect_seed", Need::kNever, 0, kIncluded, 4294967295.0, kWhole,
     [](Draft& d, double v) { d.model.defects.seed = static_cast<std::uint64_t>(v); }, "1",
     "seed of the choice of hot and dead pixels, which are the same in every frame", "32 bits"},
    {"cover_glass", "crosstalk_events", Need::kWithSection, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.cover_glass.events = v; }, "",
     "events that a pixel detects for each pulse from the cover glass in front of the sensor: an early "
     "return that is the same in every pixel",
     "a TDC keeps a few events of a pulse"},
    {"cover_glass", "distance_m", Need::kNever, 0, kIncluded, 10, kReal,
     [](Draft& d, double v) { d.model.surroundings.cover_glass.distance_m = v; }, "0.03",
     "distance of the cover glass", "a cover glass is a part of the sensor"},
    {"fog", "extinction_per_m", Need::kWithSection, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.fog.extinction_per_m = v; }, "",
     "extinction alpha of a homogeneous medium (fog, smoke, dust): a target at distance R keeps exp(-2 alpha "
     "R) of its signal; the visibility is 3.9 / alpha (Koschmieder)",
     "through a denser medium no light returns"},
    {"fog", "lidar_ratio_sr", Need::kNever, 0, kExcluded, 1000, kReal,
     [](Draft& d, double v) { d.model.surroundings.fog.lidar_ratio_sr = v; }, "18.8",
     "ratio of extinction to backscatter: about 19 sr for water droplets (O'Connor et al. 2004), 50 to 80 sr "
     "for smoke",
     "no aerosol has a ratio near the limit"},
    {"fog", "overlap_m", Need::kNever, 0, kExcluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.fog.overlap_m = v; }, "0.1",
     "distance from which on a pixel sees the light of the laser; nearer fog returns nothing",
     "a sensor that sees nothing within 100 m has no use"},
    {"pane", "distance_m", Need::kWithSection, 0, kExcluded, 1e5, kReal,
     [](Draft& d, double v) { d.model.surroundings.pane.distance_m = v; }, "",
     "distance of a pane across the whole scene; the pane adds a return in front of the targets behind it",
     "150 km are the longest range"},
    {"pane", "reflectivity", Need::kWithSection, 0, kIncluded, 4, kReal,
     [](Draft& d, double v) { d.model.surroundings.pane.reflectivity = v; }, "",
     "reflectivity of the pane as a matt surface, because of its dust; a glint is larger",
     "the limit of a target's reflectivity"},
    {"pane", "transmittance", Need::kNever, 0, kIncluded, 1, kReal,
     [](Draft& d, double v) { d.model.surroundings.pane.transmittance = v; }, "0.92",
     "share of the light that passes the pane; signal from behind passes twice, sunlight once (0.92: two "
     "surfaces of clear glass)",
     "a share"},
    {"other_laser", "events", Need::kWithSection, 0, kIncluded, 100, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.events = v; }, "",
     "events that a pixel detects for each pulse of another sensor's laser, the same in every pixel",
     "a TDC keeps a few events of a pulse"},
    {"other_laser", "rate_offset_ppm", Need::kNever, -1e5, kIncluded, 1e5, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.rate_offset = v / 1e6; }, "0",
     "rate of the other laser's pulses above that of the sensor's own laser; with a higher rate the pulses "
     "arrive earlier in each acquisition than in the one before",
     "beyond a tenth it is another rate"},
    {"other_laser", "first_arrival_ns", Need::kNever, -1e9, kIncluded, 1e9, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.first_arrival_s = v / kNano; }, "0",
     "phase: time from the begin of the frame to a pulse of the other laser; earlier pulses arrive, too",
     "a second is longer than any frame"},
    {"other_laser", "pulse_fwhm_ns", Need::kNever, 0, kExcluded, 1e6, kReal,
     [](Draft& d, double v) { d.model.surroundings.other_laser.pulse_fwhm_s = v / kNano; },
     "that of the sensor's own laser", "full width at half maximum of the other laser's Gaussian pulse",
     "a pulse is shorter than the range"},
    {"motion", "radial_velocity_m_per_s", Need::kNever, -1e4, kIncluded, 1e4, kReal,
     [](Draft& d, double v) { d.model.surroundings.motion.velocity_m_per_s = v; }, "0",
     "velocity of every target along the ray of its pixel, above 0: away from the sensor; the true distance "
     "is that in the middle of the frame",
     "faster than a bullet"},
    {"motion", "columns_per_frame", Need::kNever, -1e3, kIncluded, 1e3, kReal,
     [](Draft& d, double v) { d.model.surroundings.lateral.columns_per_frame = v; }, "0",
     "movement of the camera to the right during the frame, in columns; below 0: to the left; in the middle "
     "of the frame each pixel sees its own pixel of the scene",
     "a faster camera needs shorter frames"},
    {"motion", "rows_per_frame", Need::kNever, -1e3, kIncluded, 1e3, kReal,
     [](Draft& d, double v) { d.model.surroundings.lateral.rows_per_frame = v; }, "0",
     "movement of the camera downwards during the frame, in rows; below 0: upwards",
     "a faster camera needs shorter frames"},
});

constexpr auto kOthers = std::to_array<SensorOtherKey>({
    {"tdc", "code_widths_file", "path", "none: equal codes",
     "CSV file, plain or gzip, with measured widths of the TDC's codes (differential non-linearity) in any "
     "unit. The widths repeat until all 2^NP codes have one, and are scaled so that the codes fill the "
     "range. Widths of 0 at both ends of the list belong to taps that no event reaches, and are left out"},
    {"tdc", "code_widths_column", "text", "this or the next is required with the file",
     "name of the column that has the widths, as the first line of the file spells it"},
    {"tdc", "code_widths_row", "text", "",
     "first field of the line that has the widths. \"all\": each line is another TDC, and the pixel in a row "
     "and column has line (row * columns + column) modulo the number of lines; empty lines do not count"},
    {"tdc", "code_widths_are_edges", "true or false", "false",
     "true: the file has the upper edges of the codes, ascending, instead of the widths"},
    {"tdc", "column_skew_pattern", "\"random\", \"ramp\" or \"alternating\"", "\"random\"",
     "delay of each column, in units of column_skew_ps: random: uniform between -1 and 1; ramp: from -1 in "
     "the first column to 1 in the last; alternating: 1 in even columns, -1 in odd columns"},
    {"laser", "pulse_response_file", "path", "none: a Gaussian of pulse_fwhm_ns",
     "NPY file with the measured pulse: one dimension, values in proportion to the density. The centroid of "
     "the pulse arrives one FWHM after 2R/c, as that of the Gaussian pulse does"},
    {"detector", "hot_pixels", "list of [column, row]", "[]",
     "further hot pixels, beside those of hot_pixel_share"},
    {"detector", "dead_pixels", "list of [column, row]", "[]",
     "further dead pixels, beside those of dead_pixel_share"},
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

std::string sensor_number_error(const SensorNumberKey& key, double value, std::string_view text) {
  const bool high_enough = key.lowest_allowed ? value >= key.lowest : value > key.lowest;
  // Written so that a NaN fails.
  return high_enough && value <= key.highest ? ""
                                             : fmt::format("{} is {}, but must be {} ({})", key.name, text,
                                                           sensor_key_limits(key), key.reason);
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
