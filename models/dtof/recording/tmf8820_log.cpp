// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/tmf8820_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::string_view kHistogramLine = "#Raw,";
constexpr std::size_t kChannels = kTmf8820Zones + 1;
constexpr std::size_t kBytes = 3;
constexpr std::size_t kFieldsBefore = 3;

/// The capture whose lines are being read.
class OpenCapture {
 public:
  /// Returns false if the line is there already.
  bool add(std::size_t index, const std::array<std::uint64_t, kTmf8820Bins>& numbers) {
    if (have_.test(index)) {
      return false;
    }
    have_.set(index);
    for (std::size_t bin = 0; bin < kTmf8820Bins; ++bin) {
      counts_.at(index % kChannels).at(bin) += numbers.at(bin) << 8U * (index / kChannels);
    }
    return true;
  }

  [[nodiscard]] bool empty() const { return have_.none(); }
  [[nodiscard]] bool complete() const { return have_.all(); }

  /// The largest count of a bin.
  [[nodiscard]] std::uint64_t largest() const {
    std::uint64_t most = 0;
    for (const auto& channel : counts_) {
      most = std::max(most, *std::ranges::max_element(channel));
    }
    return most;
  }

  [[nodiscard]] Tmf8820Capture capture() const {
    Tmf8820Capture capture;
    capture.distance = std::numeric_limits<double>::quiet_NaN();
    const auto narrow = [](std::uint64_t count) { return static_cast<std::uint32_t>(count); };
    std::ranges::transform(counts_.front(), capture.reference.begin(), narrow);
    for (std::size_t zone = 0; zone < kTmf8820Zones; ++zone) {
      std::ranges::transform(counts_.at(zone + 1), capture.histograms.at(zone).begin(), narrow);
    }
    return capture;
  }

 private:
  std::bitset<kChannels * kBytes> have_;
  std::array<std::array<std::uint64_t, kTmf8820Bins>, kChannels> counts_{};
};

/// A field of a "#Raw" line; throws InputError unless it is an integer from 0 to `largest`.
std::uint64_t number(const std::string& name, std::size_t line, std::string_view field,
                     std::uint64_t largest) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || value > largest) {
    fail_at_line(name, line, fmt::format("\"{}\" is no integer from 0 to {}", field, largest));
  }
  return value;
}

}  // namespace

bool is_tmf8820_log(std::string_view text) {
  text = without_byte_order_mark(text);
  return text.starts_with(kHistogramLine) ||
         text.find("\n" + std::string(kHistogramLine)) != std::string_view::npos;
}

Tmf8820Log parse_tmf8820_log(const std::filesystem::path& path, std::string_view text) {
  text = without_byte_order_mark(text);
  const std::string name = path.string();
  Tmf8820Log log;
  OpenCapture open;
  const auto close = [&](std::size_t line) {
    if (open.complete()) {
      if (open.largest() > std::numeric_limits<std::uint32_t>::max()) {
        fail_at_line(name, line, fmt::format("a bin has {} photons, more than 2^32-1", open.largest()));
      }
      log.captures.push_back(open.capture());
    } else if (!open.empty()) {
      ++log.incomplete;
    }
    open = OpenCapture();
  };
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!content.starts_with(kHistogramLine)) {
      continue;
    }
    content.remove_suffix(content.ends_with('\r') ? 1 : 0);
    const std::vector<std::string_view> fields = split_at_commas(content);
    if (text.empty() && fields.size() < kFieldsBefore + kTmf8820Bins) {
      break;  // the recording ended in this line
    }
    if (fields.size() != kFieldsBefore + kTmf8820Bins) {
      fail_at_line(name, line,
                   fmt::format("{} fields instead of {} (#Raw, address, index and {} bins)", fields.size(),
                               kFieldsBefore + kTmf8820Bins, kTmf8820Bins));
    }
    const std::size_t index = number(name, line, fields[2], kChannels * kBytes - 1);
    std::array<std::uint64_t, kTmf8820Bins> numbers{};
    for (std::size_t bin = 0; bin < kTmf8820Bins; ++bin) {
      numbers.at(bin) =
          number(name, line, fields[kFieldsBefore + bin], std::numeric_limits<std::uint16_t>::max());
    }
    if (index == 0) {
      close(line);
    }
    if (!open.add(index, numbers)) {
      close(line);
      open.add(index, numbers);
    }
    if (open.complete()) {
      close(line);
    }
  }
  close(0);
  if (log.captures.empty()) {
    throw InputError(
        fmt::format("{}: no whole capture: one has {} lines \"#Raw\"", name, kChannels * kBytes));
  }
  return log;
}

}  // namespace dtof
