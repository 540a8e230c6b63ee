// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

class VerilatedContext;

namespace dtof {

/// An SRAM of a Verilated array with writable contents, for fault injection. Valid as long as the array's
/// model.
class RtlSram {
 public:
  /// `contents` holds `words` words of `word_bytes` bytes each; `address` has `address_bytes`.
  RtlSram(std::string path, std::uint8_t* contents, int words, int width, std::size_t word_bytes,
          const std::uint8_t* address, std::size_t address_bytes);

  /// Hierarchical path, e.g. "dtof_array_testbench.u_array.g_column[3]. ... .u_peak_sram".
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] int words() const { return words_; }
  [[nodiscard]] int width() const { return width_; }

  [[nodiscard]] bool bit(int word, int bit) const;
  void set_bit(int word, int bit, bool value);
  /// Address on the read port, settled in this clock.
  [[nodiscard]] int read_address() const;

 private:
  std::string path_;
  std::uint8_t* contents_;
  int words_;
  int width_;
  std::size_t word_bytes_;
  const std::uint8_t* address_;
  std::size_t address_bytes_;
};

/// SRAMs of the model in `context`, sorted by path; empty unless the model was built with WRITABLE_SRAMS
/// (cmake/verilate.cmake).
std::vector<RtlSram> find_srams(VerilatedContext& context);

}  // namespace dtof
