// SPDX-License-Identifier: Apache-2.0
#include "rtl/sram.hpp"

#include <verilated.h>
#include <verilated_syms.h>

#include <bit>
#include <climits>
#include <utility>

namespace dtof {
namespace {

static_assert(std::endian::native == std::endian::little, "a word's bits are counted from its first byte");

constexpr std::string_view kMacro = ".u_macro";  // of memory/dtof_sram.sv, with one generate block around it

constexpr std::string_view kWords = ".u_words";  // the dtof_sram in a dtof_parity_sram

/// The path of the dtof_sram that holds the macro `scope`, or of the dtof_parity_sram around it.
std::string sram_path(std::string_view scope) {
  const std::string_view block = scope.substr(0, scope.size() - kMacro.size());
  std::string_view path = block.substr(0, block.rfind('.'));
  if (path.ends_with(kWords)) {
    path.remove_suffix(kWords.size());
  }
  return std::string(path);
}

}  // namespace

RtlSram::RtlSram(std::string path, std::uint8_t* contents, int words, int width, std::size_t word_bytes,
                 const std::uint8_t* address, std::size_t address_bytes)
    : path_(std::move(path)),
      contents_(contents),
      words_(words),
      width_(width),
      word_bytes_(word_bytes),
      address_(address),
      address_bytes_(address_bytes) {}

bool RtlSram::bit(int word, int bit) const {
  const std::uint8_t byte =
      contents_[static_cast<std::size_t>(word) * word_bytes_ + static_cast<std::size_t>(bit / CHAR_BIT)];
  return (byte >> (bit % CHAR_BIT) & 1) != 0;
}

void RtlSram::set_bit(int word, int bit, bool value) {
  std::uint8_t& byte =
      contents_[static_cast<std::size_t>(word) * word_bytes_ + static_cast<std::size_t>(bit / CHAR_BIT)];
  const auto mask = static_cast<std::uint8_t>(1U << static_cast<unsigned>(bit % CHAR_BIT));
  byte = static_cast<std::uint8_t>(value ? byte | mask : byte & ~mask);
}

int RtlSram::read_address() const {
  int address = 0;
  for (std::size_t i = address_bytes_; i > 0; --i) {
    address = address << CHAR_BIT | address_[i - 1];
  }
  return address;
}

std::vector<RtlSram> find_srams(VerilatedContext& context) {
  std::vector<RtlSram> srams;
  for (const auto& [name, scope] : *context.scopeNameMap()) {
    const VerilatedVar* contents = scope->varFind("memory");
    if (contents == nullptr) {
      continue;
    }
    const VerilatedVar* one_port = scope->varFind("addr_i");
    const VerilatedVar* address = one_port != nullptr ? one_port : scope->varFind("raddr_i");
    srams.emplace_back(sram_path(name), static_cast<std::uint8_t*>(contents->datap()),
                       contents->unpacked().elements(), contents->packed().elements(), contents->entSize(),
                       static_cast<const std::uint8_t*>(address->datap()), address->entSize());
  }
  return srams;
}

}  // namespace dtof
