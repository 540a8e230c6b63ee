// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/picoquant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "dtof/io/byte_stream.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {

/// How a record of 32 bits is read.
struct PicoquantLayout {
  bool pico_harp = false;            ///< four bits of channel in front instead of special bit and six
  std::uint64_t overflow_t2 = 0;     ///< units that an overflow stands for
  std::uint64_t overflow_t3 = 1024;  ///< syncs
  bool counted_overflows = true;     ///< a record may stand for several
};

namespace {

using Layout = PicoquantLayout;

// Layouts as PicoQuant's demos have them: github.com/PicoQuant/PicoQuant-Time-Tagged-File-Format-Demos.
constexpr std::string_view kPtuMagic{"PQTTTR\0\0", 8};
constexpr std::string_view kHydraHarp = "HydraHarp";
constexpr int kMostChannels = 64;

constexpr Layout kPicoHarp = {true, 210698240, 65536, false};
constexpr Layout kFirstHydraHarp = {false, 33552000, 1024, false};
constexpr Layout kSecondHydraHarp = {false, 33554432, 1024, true};

/// TTResultFormat_TTTRRecType: the instrument in the low half, its version and mode in the other one.
std::optional<std::pair<Layout, int>> layout_of(std::uint64_t record_type) {
  switch (record_type) {
    case 0x00010203:
      return {{kPicoHarp, 2}};
    case 0x00010303:
      return {{kPicoHarp, 3}};
    case 0x00010204:
      return {{kFirstHydraHarp, 2}};
    case 0x00010304:
      return {{kFirstHydraHarp, 3}};
    case 0x01010204:  // HydraHarp, second version
    case 0x00010205:  // TimeHarp 260 N
    case 0x00010206:  // TimeHarp 260 P
    case 0x00010207:  // MultiHarp
      return {{kSecondHydraHarp, 2}};
    case 0x01010304:
    case 0x00010305:
    case 0x00010306:
    case 0x00010307:
      return {{kSecondHydraHarp, 3}};
    default:
      return std::nullopt;
  }
}

/// Seconds as ps, without what a double adds: 8e-12 s are 8 ps.
double to_picoseconds(double seconds) { return std::round(seconds * 1e18) * 1e-6; }

std::string until_zero(std::string_view text) { return std::string(text.substr(0, text.find('\0'))); }

}  // namespace

/// The file's bytes, its header and the state of its clock.
class PicoquantFile::Reader {
 public:
  explicit Reader(std::filesystem::path path) : bytes_(path), path_(std::move(path)) { read_header(); }
  Reader(std::filesystem::path path, std::string_view contents)
      : bytes_(path, contents), path_(std::move(path)) {
    read_header();
  }

  PicoquantCount read(const std::function<void(const PicoquantEvent&)>& take) {
    const std::uint64_t most =
        header.records == 0 ? std::numeric_limits<std::uint64_t>::max() : header.records;
    PicoquantCount count;
    std::uint32_t record = 0;
    while (count.records < most && bytes_.take_number(record, "record", count.records)) {
      ++count.records;
      const auto event = layout_.pico_harp ? pico_harp_event(record, count) : hydra_harp_event(record, count);
      if (!event) {
        continue;
      }
      ++(event->channel == PicoquantEvent::kSync ? count.syncs : count.photons);
      take(*event);
    }
    return count;
  }

  PicoquantHeader header;

 private:
  void read_header() {
    const std::string start = bytes_.take(16, "its header");
    if (start.starts_with(kPtuMagic)) {
      read_ptu_header();
    } else if (start.starts_with(kHydraHarp)) {
      read_ht_header();
    } else {
      fail_in_file(path_, "neither a PTU nor an HT3 file");
    }
    if (!std::isfinite(header.unit_ps) || header.unit_ps <= 0.0) {
      fail_in_file(path_, fmt::format("the header's resolution is {:g} ps, must be above 0", header.unit_ps));
    }
  }

  struct Tag {
    std::string name;
    std::uint32_t type;
    std::uint64_t bits;
    std::string text;
  };

  Tag take_tag() {
    constexpr std::size_t kNameSize = 32;
    constexpr std::size_t kLongestPayload = std::size_t{1} << 26U;
    const std::string raw = bytes_.take(48, "its header");
    Tag tag{.name = until_zero(std::string_view(raw).substr(0, kNameSize)),
            .type = number_at<std::uint32_t>(raw, 36),
            .bits = number_at<std::uint64_t>(raw, 40),
            .text = {}};
    switch (tag.type) {
      case 0xFFFF0008:  // empty
      case 0x00000008:  // bool
      case 0x10000008:  // integer
      case 0x11000008:  // bits
      case 0x12000008:  // colour
      case 0x20000008:  // double
      case 0x21000008:  // date
        return tag;
      case 0x2001FFFF:  // doubles
      case 0x4001FFFF:  // text
      case 0x4002FFFF:  // text of 16 bits a letter
      case 0xFFFFFFFF:  // bytes
        if (tag.bits > kLongestPayload) {
          fail_in_file(path_,
                       fmt::format("the header's entry '{}' has {} bytes: damaged", tag.name, tag.bits));
        }
        tag.text = bytes_.take(tag.bits, "its header");
        return tag;
      default:
        fail_in_file(path_, fmt::format("the header's entry '{}' is of an unknown type, {:#010x}: damaged",
                                        tag.name, tag.type));
    }
  }

  void read_ptu_header() {
    constexpr int kMostTags = 65536;
    std::uint64_t record_type = 0;
    double global_resolution = 0.0;
    double resolution = 0.0;
    bool ended = false;
    for (int count = 0; !ended; ++count) {
      if (count == kMostTags) {
        fail_in_file(path_, "the header has no end");
      }
      const Tag tag = take_tag();
      const auto number = std::bit_cast<double>(tag.bits);
      if (tag.name == "HW_Type") {
        header.instrument = until_zero(tag.text);
      } else if (tag.name == "TTResultFormat_TTTRRecType") {
        record_type = tag.bits;
      } else if (tag.name == "TTResult_NumberOfRecords") {
        header.records = tag.bits;
      } else if (tag.name == "TTResult_SyncRate") {
        header.sync_rate = static_cast<double>(tag.bits);
      } else if (tag.name == "MeasDesc_GlobalResolution") {
        global_resolution = number;
      } else if (tag.name == "MeasDesc_Resolution") {
        resolution = number;
      }
      ended = tag.name == "Header_End";
    }
    if (record_type == 0) {
      fail_in_file(path_, "the header has no TTResultFormat_TTTRRecType: the file has no time tags");
    }
    const auto known = layout_of(record_type);
    if (!known) {
      fail_in_file(path_, fmt::format("records of type {:#010x} are unknown", record_type));
    }
    std::tie(layout_, header.mode) = *known;
    header.unit_ps = to_picoseconds(header.mode == 2 ? global_resolution : resolution);
  }

  // A header of fixed places; what stands behind the inputs moves with their number.
  void read_ht_header() {
    constexpr std::size_t kInputs = 0x2b8;
    std::string text(16, '\0');
    text += bytes_.take(kInputs - text.size(), "its header");
    const std::string version = until_zero(std::string_view(text).substr(16, 6));
    if (version != "1.0" && version != "2.0") {
      fail_in_file(path_, fmt::format("HydraHarp format '{}' is not 1.0 or 2.0", version));
    }
    const auto bits = number_at<std::int32_t>(text, 0x14c);
    header.mode = number_at<std::int32_t>(text, 0x154);
    const auto channels = number_at<std::int32_t>(text, 0x298);
    if (bits != 32 || (header.mode != 2 && header.mode != 3) || channels < 0 || channels > kMostChannels) {
      fail_in_file(path_,
                   fmt::format("the header has {} bits a record, mode {} and {} inputs, not 32 bits, mode 2 "
                               "or 3 and up to {} inputs",
                               bits, header.mode, channels, kMostChannels));
    }
    header.instrument = until_zero(std::string_view(text).substr(0x218, 16));
    header.unit_ps = number_at<double>(text, header.mode == 3 ? 0x160 : 0x288);
    layout_ = version == "1.0" ? kFirstHydraHarp : kSecondHydraHarp;
    // Each input has four settings and a rate; then follow the sync's rate, two numbers, the length of an
    // image header in words, and the number of records.
    (void)bytes_.take(static_cast<std::size_t>(channels) * 20, "its header");
    const std::string last = bytes_.take(24, "its header");
    header.sync_rate = number_at<std::int32_t>(last, 0);
    const auto image_words = number_at<std::int32_t>(last, 12);
    const auto records = number_at<std::int64_t>(last, 16);
    constexpr std::int32_t kLongestImageHeader = 1 << 20;
    if (image_words < 0 || image_words > kLongestImageHeader || records < 0) {
      fail_in_file(path_, fmt::format("the header has an image header of {} words and {} records: damaged",
                                      image_words, records));
    }
    header.records = static_cast<std::uint64_t>(records);
    (void)bytes_.take(static_cast<std::size_t>(image_words) * 4, "its header");
  }

  std::optional<PicoquantEvent> hydra_harp_event(std::uint32_t record, PicoquantCount& count) {
    constexpr std::uint32_t kOverflow = 0x3F;
    const bool special = (record >> 31U) != 0;
    const std::uint32_t channel = record >> 25U & 0x3FU;
    const std::uint32_t syncs = record & 0x3FFU;            // T3
    const std::uint32_t time_t3 = record >> 10U & 0x7FFFU;  // T3
    const std::uint32_t time_t2 = record & 0x1FFFFFFU;      // T2
    const bool t3 = header.mode == 3;
    if (special && channel == kOverflow) {
      const std::uint32_t said = t3 ? syncs : time_t2;
      clock_ += (t3 ? layout_.overflow_t3 : layout_.overflow_t2) *
                (layout_.counted_overflows && said != 0 ? said : 1U);
      return std::nullopt;
    }
    if (special && (t3 || channel != 0)) {
      ++count.markers;
      return std::nullopt;
    }
    if (t3) {
      return PicoquantEvent{.channel = static_cast<int>(channel), .sync = clock_ + syncs, .time = time_t3};
    }
    return PicoquantEvent{.channel = special ? PicoquantEvent::kSync : static_cast<int>(channel),
                          .sync = 0,
                          .time = clock_ + time_t2};
  }

  std::optional<PicoquantEvent> pico_harp_event(std::uint32_t record, PicoquantCount& count) {
    constexpr std::uint32_t kSpecial = 0xF;
    const std::uint32_t channel = record >> 28U;
    const bool t3 = header.mode == 3;
    const std::uint32_t time_t3 = record >> 16U & 0xFFFU;
    const std::uint32_t time_t2 = record & 0xFFFFFFFU;
    if (channel == kSpecial) {
      const bool overflow = (t3 ? time_t3 : time_t2 & 0xFU) == 0;
      clock_ += overflow ? (t3 ? layout_.overflow_t3 : layout_.overflow_t2) : 0U;
      count.markers += overflow ? 0 : 1;
      return std::nullopt;
    }
    // The first input is the sync's; with a router T3 counts the detectors from 1.
    if (t3) {
      return PicoquantEvent{.channel = std::max(0, static_cast<int>(channel) - 1),
                            .sync = clock_ + (record & 0xFFFFU),
                            .time = time_t3};
    }
    return PicoquantEvent{.channel = static_cast<int>(channel) - 1, .sync = 0, .time = clock_ + time_t2};
  }

  ByteStream bytes_;
  std::filesystem::path path_;
  PicoquantLayout layout_;
  std::uint64_t clock_ = 0;  ///< what the overflows have counted: T2 units, T3 syncs
};

bool is_picoquant(std::string_view start) {
  return start.starts_with(kPtuMagic) || start.starts_with(kHydraHarp);
}

PicoquantFile::PicoquantFile(std::filesystem::path path)
    : reader_(std::make_unique<Reader>(std::move(path))) {}
PicoquantFile::PicoquantFile(std::filesystem::path path, std::string_view contents)
    : reader_(std::make_unique<Reader>(std::move(path), contents)) {}
PicoquantFile::~PicoquantFile() = default;
const PicoquantHeader& PicoquantFile::header() const { return reader_->header; }
PicoquantCount PicoquantFile::read(const std::function<void(const PicoquantEvent&)>& take) {
  return reader_->read(take);
}

std::string picoquant_description(const PicoquantHeader& header, const PicoquantCount& count) {
  std::string text = fmt::format("PicoQuant{}{}, T{}, {} photons", header.instrument.empty() ? "" : " ",
                                 header.instrument, header.mode, count.photons);
  if (count.syncs != 0) {
    text += fmt::format(" and {} syncs", count.syncs);
  }
  if (count.markers != 0) {
    text += fmt::format(", {} markers left out", count.markers);
  }
  if (count.records < header.records) {
    text += fmt::format(", {} of the {} records that the header names are missing",
                        header.records - count.records, header.records);
  }
  return text;
}

namespace {

/// Histograms of a file that has just been opened.
HistogramCube cube_of(const std::filesystem::path& path, PicoquantFile& file, std::string& description) {
  constexpr std::uint64_t kMostBins = std::uint64_t{1} << 20U;
  const bool t3 = file.header().mode == 3;
  std::vector<std::vector<double>> channels;
  std::optional<std::uint64_t> last_sync;
  std::uint64_t beyond = 0;
  const PicoquantCount count = file.read([&](const PicoquantEvent& event) {
    if (event.channel == PicoquantEvent::kSync) {
      last_sync = event.time;
      return;
    }
    const std::uint64_t time = t3 ? event.time : event.time - last_sync.value_or(event.time);
    if ((!t3 && !last_sync) || time >= kMostBins) {
      ++beyond;
      return;
    }
    const auto channel = static_cast<std::size_t>(event.channel);
    channels.resize(std::max(channels.size(), channel + 1));
    channels[channel].resize(std::max(channels[channel].size(), static_cast<std::size_t>(time) + 1), 0.0);
    ++channels[channel][time];
  });
  if (count.photons == 0) {
    fail_in_file(path, fmt::format("the file has no photons in its {} records", count.records));
  }
  if (!t3 && count.syncs == 0) {
    fail_in_file(path, "the file is of mode T2 and has no syncs: no time of a photon has a begin");
  }
  if (channels.empty()) {
    fail_in_file(path, fmt::format("no photon is within {} bins behind a sync", kMostBins));
  }
  std::size_t bins = 0;
  for (const std::vector<double>& counts : channels) {
    bins = std::max(bins, counts.size());
  }
  HistogramCube cube;
  cube.name = path.string();
  cube.columns = static_cast<int>(channels.size());
  cube.rows = 1;
  cube.bins = static_cast<int>(bins);
  cube.bin_width = file.header().unit_ps * 1e-12;
  for (std::vector<double>& counts : channels) {
    counts.resize(bins, 0.0);
    cube.counts.insert(cube.counts.end(), counts.begin(), counts.end());
  }
  description = picoquant_description(file.header(), count);
  if (beyond != 0) {
    description += fmt::format(", {} without a sync before or beyond {} bins left out", beyond, kMostBins);
  }
  return cube;
}

}  // namespace

HistogramCube picoquant_cube(const std::filesystem::path& path, std::string& description) {
  PicoquantFile file(path);
  return cube_of(path, file, description);
}

HistogramCube picoquant_cube(const std::filesystem::path& path, std::string_view contents,
                             std::string& description) {
  PicoquantFile file(path, contents);
  return cube_of(path, file, description);
}

}  // namespace dtof
