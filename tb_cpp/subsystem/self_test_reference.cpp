// SPDX-License-Identifier: Apache-2.0
#include "subsystem/self_test_reference.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

#include "dtof.h"
#include "dtof/readout/model.hpp"

namespace dtof {

SelfTestLines::SelfTestLines(const RtlConfiguration& configuration, std::uint32_t seed)
    : np_(configuration.parameters.np),
      columns_(static_cast<std::size_t>(configuration.sram_num)),
      rows_(static_cast<std::size_t>(configuration.pixels_per_sram)),
      slots_(static_cast<std::size_t>(configuration.parameters.slots)),
      state_(seed == 0 ? 1 : seed) {}

Line SelfTestLines::next() {
  const int coarse_bits = std::min(5, np_ - 1);
  const int fine_bits = np_ - coarse_bits;
  const std::uint32_t coarse_mask = (1U << coarse_bits) - 1U;
  const std::uint32_t none = (1U << np_) - 1U;
  Line line(columns_);
  for (std::size_t column = 0; column < columns_; ++column) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(column + 1) * 0x9E3779B1U;
    const std::uint32_t random = std::rotr(state_, static_cast<int>(5 * column % 32)) ^ mixed;
    const bool on_target = (random >> 17U & 1U) != 0;
    const bool dark = (random >> 16U & 3U) == 1U;
    const std::uint32_t coarse = (on_target ? row_code_ ^ mixed >> 27U : random >> 11U) & coarse_mask;
    const std::uint32_t fine = random & ((1U << fine_bits) - 1U);
    line[column] = static_cast<Timestamp>(dark ? none : coarse << fine_bits | fine);
  }
  state_ ^= state_ << 13U;
  state_ ^= state_ >> 17U;
  state_ ^= state_ << 5U;
  if (++slot_ == slots_) {
    slot_ = 0;
    row_ = row_ + 1 == rows_ ? 0 : row_ + 1;
    row_code_ = row_ == 0 ? 0 : row_code_ + 19U;
  }
  return line;
}

std::vector<ColumnStream> self_test_streams(const RtlConfiguration& configuration, std::uint32_t acquisitions,
                                            std::uint32_t seed) {
  const auto columns = static_cast<std::size_t>(configuration.sram_num);
  const auto rows = static_cast<std::size_t>(configuration.pixels_per_sram);
  const auto none = static_cast<Timestamp>(configuration.parameters.no_detection());
  SelfTestLines lines(configuration, seed);
  std::vector<std::vector<std::vector<Detection>>> pixels(columns, std::vector<std::vector<Detection>>(rows));
  for (std::uint32_t acquisition = 0; acquisition < acquisitions; ++acquisition) {
    for (std::size_t row = 0; row < rows; ++row) {
      for (int slot = 0; slot < configuration.parameters.slots; ++slot) {
        const Line line = lines.next();
        for (std::size_t column = 0; column < columns; ++column) {
          if (line[column] != none) {
            pixels[column][row].push_back({acquisition, line[column]});
          }
        }
      }
    }
  }
  std::vector<ColumnStream> streams(columns);
  for (std::size_t column = 0; column < columns; ++column) {
    for (const std::vector<Detection>& detections : pixels[column]) {
      streams[column].append_row(detections);
    }
  }
  return streams;
}

std::uint32_t self_test_signature(const RtlConfiguration& configuration, bool raster_order,
                                  std::uint32_t acquisitions, std::uint32_t seed) {
  ReadoutParameters parameters = configuration.parameters;
  parameters.time_gate.reset();  // software opens the gate, so that no timestamp lies outside
  parameters.pool.smooth = true;
  parameters.pool.coarse_template = {};
  const std::vector<std::vector<PixelResult>> results =
      make_readout_model(parameters)
          ->run_columns(self_test_streams(configuration, acquisitions, seed), acquisitions);
  const bool pool = is_pool_readout(parameters.readout);
  const bool has_confidence = !is_pointer_readout(parameters.readout) || parameters.confidence_width > 0;
  const int largest =
      (1 << (is_pointer_readout(parameters.readout) ? parameters.confidence_width : parameters.count_width)) -
      1;
  std::vector<ResultAddress> order = configuration.result_order();
  if (raster_order) {
    std::ranges::sort(order, {},
                      [](const ResultAddress& pixel) { return std::tuple(pixel.row, pixel.column); });
  }
  std::vector<std::uint64_t> words;
  words.reserve(order.size());
  for (const ResultAddress& pixel : order) {
    const PixelResult& result =
        results[static_cast<std::size_t>(pixel.column)][static_cast<std::size_t>(pixel.row)];
    const auto confidence = static_cast<std::uint64_t>(has_confidence ? result.confidence : 0);
    const auto position =
        static_cast<std::uint64_t>((result.code << parameters.fraction_bits) + result.fraction);
    const bool empty = has_confidence && confidence == 0;
    const bool saturated = has_confidence && !pool && result.confidence == largest;
    words.push_back(position << DTOF_RESULT_POSITION_LSB | confidence << DTOF_RESULT_CONFIDENCE_LSB |
                    static_cast<std::uint64_t>(pixel.row) << DTOF_RESULT_ROW_LSB |
                    static_cast<std::uint64_t>(pixel.column) << DTOF_RESULT_COLUMN_LSB |
                    (empty ? DTOF_RESULT_EMPTY_MASK : DTOF_RESULT_VALID_MASK) |
                    (saturated ? DTOF_RESULT_SATURATED_MASK : 0));
  }
  return dtof_crc(words.data(), words.size());
}

}  // namespace dtof
