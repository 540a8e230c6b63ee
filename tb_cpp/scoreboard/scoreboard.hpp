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

/// A pixel whose RTL result differs from the model's.
struct Mismatch {
  int column = 0;
  int row = 0;
  PixelResult expected;     ///< model
  PixelResult actual;       ///< RTL
  std::uint64_t cycle = 0;  ///< clock of the result, since start

  bool operator==(const Mismatch&) const = default;
};

/// Data that help to find the fault in a frame.
struct FrameContext {
  RtlConfiguration configuration;
  std::uint32_t acquisitions = 0;
  std::uint64_t seed = 0;
  std::string reproduce;  ///< command that runs the frame again with a trace
  /// Acquisitions of the shortest frame, cut from this frame's beginning, that still differs.
  std::optional<std::uint32_t> shortest_failing_frame;
};

/// Returns `column` with dark rows added up to PIXELS_PER_SRAM. In a pool read-out they influence the other
/// rows.
ColumnStream with_dark_rows(ColumnStream column, const RtlConfiguration& configuration);

/// Returns all differing pixels of two row-major frames over `columns` (column numbers in the array or
/// scene). Throws InputError if the sizes do not match.
std::vector<Mismatch> compare_frames(std::span<const int> columns, std::span<const PixelResult> expected,
                                     std::span<const PixelResult> actual,
                                     std::span<const std::uint64_t> result_cycles);

/// Text of several lines: number of differing pixels among `pixels`, details of the first few, context,
/// command.
std::string describe_mismatches(std::span<const Mismatch> mismatches, std::size_t pixels,
                                const FrameContext& context);

/// Runs the frame on `rtl` and on the model. Returns an empty text if all pixels agree; else a description,
/// for which the shortest failing frame is searched. `frame`, if given, receives the RTL's frame.
std::string check_frame(RtlReadout& rtl, std::span<const ColumnStream> columns, std::uint32_t acquisitions,
                        const RtlRunOptions& options, const std::string& reproduce,
                        RtlFrame* frame = nullptr);

/// Origin of a frame, and the command that runs it again.
struct SourceFrameContext {
  int threads = 0;
  int first_row = 0;  ///< sensor row of the source's row 0
  std::uint64_t seed = 0;
  std::string command;  ///< command that reproduces the run, without --readout, --columns and --trace
};

/// Compares every pixel of a frame that the RTL read from `columns` of `source` with the model. Returns an
/// empty text if all agree, else a description.
std::string check_source_frame(const StreamSource& source, const ReadoutParameters& parameters,
                               std::span<const int> columns, const RtlSourceFrame& actual,
                               const SourceFrameContext& frame);

}  // namespace dtof
