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

/// What a time tagger of PicoQuant says in front of its records.
struct PicoquantHeader {
  std::string instrument;     ///< as the file has it, e.g. "HydraHarp 400"
  int mode = 3;               ///< 2: every event has a time of its own; 3: since the last sync
  std::uint64_t records = 0;  ///< as the header says; 0: the measurement was not ended, or had none
  double unit_ps = 1.0;       ///< of PicoquantEvent::time
  double sync_rate = 0.0;     ///< Hz; 0: not known, or no sync
};

/// One event.
struct PicoquantEvent {
  static constexpr int kSync = -1;  ///< T2: the laser's pulse
  int channel = 0;                  ///< kSync, or the detector's, counted from 0
  std::uint64_t sync = 0;           ///< T3: number of syncs before
  std::uint64_t time = 0;           ///< units; T3: since that sync, T2: since the measurement's begin
};

/// What a file had.
struct PicoquantCount {
  std::uint64_t records = 0;  ///< of every kind, overflows among them
  std::uint64_t photons = 0;
  std::uint64_t syncs = 0;    ///< T2
  std::uint64_t markers = 0;  ///< of scanners and the like; they are passed over
};

/// Whether a file begins as a PTU or HT3 (HT2) file does.
bool is_picoquant(std::string_view start);

/// A PTU file (PicoHarp 300, HydraHarp 400, TimeHarp 260, MultiHarp 150/160) or an HT3 or HT2 file of a
/// HydraHarp, format 1.0 or 2.0; plain or gzip. The file is read piece by piece, from its beginning to its
/// end, and may be longer than memory.
class PicoquantFile {
 public:
  /// Reads the header. Throws InputError "<path>: <reason>".
  explicit PicoquantFile(std::filesystem::path path);
  PicoquantFile(const PicoquantFile&) = delete;
  PicoquantFile& operator=(const PicoquantFile&) = delete;
  PicoquantFile(PicoquantFile&&) = delete;
  PicoquantFile& operator=(PicoquantFile&&) = delete;
  ~PicoquantFile();

  [[nodiscard]] const PicoquantHeader& header() const;
  /// Gives every photon and sync to `take`, once. As many records are read as the header says, all where it
  /// says 0, and what there is where the file ends before: the count tells. Throws InputError for a file that
  /// ends within a record or is damaged.
  PicoquantCount read(const std::function<void(const PicoquantEvent&)>& take);

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

/// "HydraHarp 400, T3, 44141 photons", and what is missing.
std::string picoquant_description(const PicoquantHeader& header, const PicoquantCount& count);

/// Histograms of the times since the last sync: each detector of the file is a column, a bin is the file's
/// unit. Throws InputError for a file without photons, and in mode T2 without syncs.
HistogramCube picoquant_cube(const std::filesystem::path& path, std::string& description);

}  // namespace dtof
