// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "rtl/rtl_readout.hpp"
#include "rtl/run_frame.hpp"

namespace dtof {

/// A pixel whose RTL result is not the model's.
struct Mismatch {
  int column = 0;
  int row = 0;
  PixelResult expected;     ///< model
  PixelResult actual;       ///< RTL
  std::uint64_t cycle = 0;  ///< clock of the result, since start

  bool operator==(const Mismatch&) const = default;
};

/// What a reader needs beside the pixel to find the fault.
struct FrameContext {
  RtlConfiguration configuration;
  std::uint32_t acquisitions = 0;
  std::uint64_t seed = 0;
  std::string reproduce;  ///< command that runs the frame again with a trace
  /// Length of the shortest frame found that still differs, cut from this one's beginning.
  std::optional<std::uint32_t> shortest_failing_frame;
};

/// `column` as the array sees it: rows without a detection are added up to PIXELS_PER_SRAM. A pool read-out's
/// other rows see them.
ColumnStream with_dark_rows(ColumnStream column, const RtlConfiguration& configuration);

/// Every differing pixel of two row-major frames over `columns` (their numbers in the array or scene).
/// Throws InputError if the sizes do not belong together.
std::vector<Mismatch> compare_frames(std::span<const int> columns, std::span<const PixelResult> expected,
                                     std::span<const PixelResult> actual,
                                     std::span<const std::uint64_t> result_cycles);

/// Several lines: how many of `pixels` differ, the first few in full, the context, the command.
std::string describe_mismatches(std::span<const Mismatch> mismatches, std::size_t pixels,
                                const FrameContext& context);

/// Runs the frame on `rtl` and on the model; empty if every pixel agrees, else the description, with the
/// shortest failing frame searched for. `frame`, if given, receives the RTL's frame.
std::string check_frame(RtlReadout& rtl, std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                        const RtlRunOptions& options, const std::string& reproduce,
                        RtlFrame* frame = nullptr);

/// Whose frame it is and how to run it again.
struct SourceFrameContext {
  int threads = 0;
  int first_row = 0;  ///< sensor row of the source's row 0
  std::uint64_t seed = 0;
  std::string command;  ///< reproduces the run, without --readout, --columns and --trace
};

/// Compares every pixel of a frame that the RTL read from `columns` of `source` with the model's; empty if
/// all agree, else the description.
std::string check_source_frame(const StreamSource& source, const ReadoutParameters& parameters,
                               std::span<const int> columns, const RtlSourceFrame& actual,
                               const SourceFrameContext& frame);

}  // namespace dtof
