// SPDX-License-Identifier: Apache-2.0
#include "product/product_driver.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <vector>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/photon/photon_source.hpp"
#include "subsystem/self_test_reference.hpp"

namespace dtof {
namespace {

/// The entries of TEMPLATE as a C array, with a sentence of how to write them; nothing without a template.
std::string template_array(const PoolTemplate& coarse_template) {
  if (coarse_template == PoolTemplate{}) {
    return "";
  }
  return fmt::format(
      "/* What decode takes from the coarse bins, for dtof_set_template between frames. */\n"
      "static const uint8_t dtof_product_template[DTOF_TEMPLATE_ENTRIES] = {{{}}};\n\n",
      fmt::join(coarse_template, ", "));
}

/// Settings and checksum for dtof_self_test, with a sentence of how to use them.
std::string self_test_settings(const SelfTest& test, const std::string& schedule) {
  return fmt::format(
      "/* For dtof_self_test: write these settings before it, with a TEMPLATE of 0; then those of the "
      "product. */\n"
      "#define DTOF_PRODUCT_SELF_TEST_ACQUISITIONS {}\n#define DTOF_PRODUCT_SELF_TEST_SEED 0x{:08X}UL\n"
      "#define DTOF_PRODUCT_SELF_TEST_EXPECTED 0x{:08X}UL\n\n"
      "static inline dtof_settings dtof_product_self_test_settings(const dtof_device *device) {{\n"
      "  dtof_settings settings = dtof_default_settings(device, DTOF_PRODUCT_SELF_TEST_ACQUISITIONS);\n{}"
      "  return settings;\n}}\n\n",
      test.acquisitions, test.seed, test.expected, schedule);
}

}  // namespace

int result_fraction_bits(const ReadoutParameters& parameters) {
  const bool has = is_pointer_readout(parameters.readout) || is_pool_readout(parameters.readout) ||
                   parameters.readout == Readout::kCoarseHistogram;
  return has ? parameters.fraction_bits : 0;
}

SelfTest product_self_test(const ProductRequest& request, std::uint32_t acquisitions) {
  constexpr std::uint32_t kSeed = 1;
  return {acquisitions, kSeed, self_test_signature(product_array(request), false, acquisitions, kSeed)};
}

std::string product_driver_header(const ProductRequest& request, const SelfTest& self_test) {
  const SensorModel sensor = request.sensor.as_calibrated();
  const FlatCalibration calibration(sensor);
  const std::array<ReadoutParameters, 1> readouts = {request.parameters};
  const std::vector<RangeConverter> tables = calibration.fit(
      [&](const TargetMap& targets) {
        return make_source(Fidelity::kExact, PhotonSource(sensor, targets, request.klux, request.seed,
                                                          FlatCalibration::kFrame));
      },
      readouts, request.seed, request.threads);
  const auto& knots = tables.front().table().knots();
  std::string points;
  for (const CalibrationPoint& knot : knots) {
    points += fmt::format("    {{{:.6f}, {:.4f}}},\n", knot.position, knot.distance_m * 1e3);
  }
  const PoolPointerParameters& pool = request.parameters.pool;
  std::string schedule;
  std::string changes;
  if (is_pool_readout(request.parameters.readout)) {
    schedule = fmt::format("  settings.coarse_share = {};\n  settings.track_share = {};\n", pool.coarse_share,
                           pool.track_share);
    changes = schedule + fmt::format("  settings.smooth = {};\n", pool.smooth);
  }
  if (request.parameters.time_gate) {
    changes += fmt::format("  settings.gate_begin = {};\n  settings.gate_end = {};\n",
                           request.parameters.time_gate->begin, request.parameters.time_gate->end);
  }
  return fmt::format(
      "/* SPDX-License-Identifier: Apache-2.0\n * {} for the sensor {}: its settings, and the look-up table "
      "from {} at\n * {:g} klux. Written "
      "by dtof product. */\n"
      "#ifndef DTOF_PRODUCT_H\n#define DTOF_PRODUCT_H\n\n#include \"dtof.h\"\n\n"
      "#define DTOF_PRODUCT_TIMESTAMP_BITS {}\n#define DTOF_PRODUCT_FRACTION_BITS {}\n#define "
      "DTOF_PRODUCT_ACQUISITIONS {}\n"
      "#define DTOF_PRODUCT_COLUMNS {}\n#define DTOF_PRODUCT_ROWS {}\n#define "
      "DTOF_PRODUCT_COLUMNS_PER_SRAM {}\n"
      "#define DTOF_PRODUCT_CODE_PS {:.6f}\n#define DTOF_PRODUCT_FWHM_PS {:.6f}\n#define DTOF_PRODUCT_POINTS "
      "{}\n\n"
      "/* The sensor's column and row of a result, from the column and the row of its word. */\n"
      "static inline unsigned dtof_product_column(unsigned column, unsigned row) {{\n"
      "  return column * DTOF_PRODUCT_COLUMNS_PER_SRAM + row / DTOF_PRODUCT_ROWS;\n}}\n\n"
      "static inline unsigned dtof_product_row(unsigned row) {{ return row % DTOF_PRODUCT_ROWS; }}\n\n"
      "static inline dtof_settings dtof_product_settings(const dtof_device *device) {{\n"
      "  dtof_settings settings = dtof_default_settings(device, DTOF_PRODUCT_ACQUISITIONS);\n{}  return "
      "settings;\n}}\n\n{}{}"
      "static const dtof_point dtof_product_table[DTOF_PRODUCT_POINTS] = {{\n{}}};\n\n#endif\n",
      readout_title(request.parameters.readout), request.sensor.name, calibration.description(), request.klux,
      request.parameters.np, result_fraction_bits(request.parameters), request.sensor.acquisitions,
      request.sensor.columns, request.sensor.rows, request.columns_per_sram,
      request.sensor.time_resolution_s() * 1e12, request.sensor.pulse_fwhm_s * 1e12, knots.size(), changes,
      request.self_test ? self_test_settings(self_test, schedule) : "", template_array(pool.coarse_template),
      points);
}

}  // namespace dtof
