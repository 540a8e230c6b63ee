// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

/// Header of a time-tag file of PicoQuant.
struct PicoquantHeader {
  std::string instrument;  ///< name in the file, e.g. "HydraHarp 400"
  int mode = 3;            ///< 2: an event's time counts from the measurement's start; 3: from the last sync
  std::uint64_t records = 0;  ///< number by the header; 0: the measurement did not end, or has none
  double unit_ps = 1.0;       ///< unit of PicoquantEvent::time
  double sync_rate = 0.0;     ///< Hz; 0: unknown, or no sync
};

/// One event.
struct PicoquantEvent {
  static constexpr int kSync = -1;  ///< channel of a laser pulse in T2
  int channel = 0;                  ///< kSync, or the detector's channel, counted from 0
  std::uint64_t sync = 0;           ///< T3: number of syncs before the event
  std::uint64_t time = 0;           ///< in units; T3: since the last sync, T2: since the measurement's start
};

/// Numbers of records in a file.
struct PicoquantCount {
  std::uint64_t records = 0;  ///< of all kinds, overflows included
  std::uint64_t photons = 0;
  std::uint64_t syncs = 0;    ///< T2
  std::uint64_t markers = 0;  ///< markers of scanners and the like, which are skipped
};

/// True if a file begins as a PTU, HT3 or HT2 file does.
bool is_picoquant(std::string_view start);

/// A PTU file (PicoHarp 300, HydraHarp 400, TimeHarp 260, MultiHarp 150/160), or an HT3 or HT2 file of a
/// HydraHarp (format 1.0 or 2.0); plain or gzip. The file is read piece by piece from beginning to end and
/// may be larger than memory.
class PicoquantFile {
 public:
  /// Reads the header. Throws InputError "<path>: <reason>".
  explicit PicoquantFile(std::filesystem::path path);
  /// Reads contents that were read from `path`, unpacked; they must outlive the object.
  PicoquantFile(std::filesystem::path path, std::string_view contents);
  PicoquantFile(const PicoquantFile&) = delete;
  PicoquantFile& operator=(const PicoquantFile&) = delete;
  PicoquantFile(PicoquantFile&&) = delete;
  PicoquantFile& operator=(PicoquantFile&&) = delete;
  ~PicoquantFile();

  [[nodiscard]] const PicoquantHeader& header() const;
  /// Passes every photon and sync to `take`; call it once. Reads the number of records in the header, or all
  /// if that is 0. A file with fewer records is read to its end, as the returned count shows. Throws
  /// InputError for a file that ends within a record or is damaged.
  PicoquantCount read(const std::function<void(const PicoquantEvent&)>& take);

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

/// Text, e.g. "HydraHarp 400, T3, 44141 photons", and what is missing.
std::string picoquant_description(const PicoquantHeader& header, const PicoquantCount& count);

/// Reads histograms of the times since the last sync. Each detector is a column; a bin is one unit of the
/// file. Sets `description`. Throws InputError for a file without photons, and in mode T2 without syncs.
HistogramCube picoquant_cube(const std::filesystem::path& path, std::string& description);
/// Reads contents that were read from `path`, unpacked.
HistogramCube picoquant_cube(const std::filesystem::path& path, std::string_view contents,
                             std::string& description);

}  // namespace dtof
