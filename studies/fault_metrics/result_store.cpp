// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/result_store.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>

#include "dtof/io/atomic_file.hpp"

namespace dtof {
namespace {

constexpr const char* kProgram = "/proc/self/exe";

/// FNV-1a of a file's bytes (Fowler, Noll and Vo).
std::uint64_t digest(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (std::istreambuf_iterator<char> byte(file), end; byte != end; ++byte) {
    hash = (hash ^ static_cast<unsigned char>(*byte)) * 0x100000001B3U;
  }
  return hash;
}

std::string counts_text(const FaultCounts& c) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {}", c.faults, c.harmful, c.beyond, c.by_parity,
                     c.by_protocol, c.by_frame_check, c.by_self_test, c.undetected, c.undetected_beyond,
                     c.latent);
}

bool read_counts(std::istream& in, FaultCounts& c) {
  in >> c.faults >> c.harmful >> c.beyond >> c.by_parity >> c.by_protocol >> c.by_frame_check >>
      c.by_self_test >> c.undetected >> c.undetected_beyond >> c.latent;
  return !in.fail();
}

}  // namespace

std::string result_key(const MetricStudyOptions& options, const std::filesystem::path& netlist) {
  return fmt::format("acquisitions {} faults {} seed {} netlist {:016x} program {:016x}",
                     options.acquisitions, options.faults, options.seed, digest(netlist), digest(kProgram));
}

void store_result(const std::filesystem::path& path, const std::string& key, const ArrayResult& result) {
  std::string text = fmt::format("{}\n{} {} {} {} {} {}\n", key, result.readout, result.parity ? 1 : 0,
                                 result.rows, result.columns, result.clocks, result.strata.size());
  for (const StratumResult& one : result.strata) {
    text += fmt::format("{} {} {} {} {} {} {}\n", static_cast<int>(one.part), static_cast<int>(one.element),
                        static_cast<int>(one.repeated), one.sites, one.full_sites, counts_text(one.events),
                        counts_text(one.stuck));
  }
  write_file(path, text + "end\n");
}

std::optional<ArrayResult> stored_result(const std::filesystem::path& path, const std::string& key) {
  std::ifstream file(path);
  std::string first;
  if (!std::getline(file, first) || first != key) {
    return std::nullopt;
  }
  ArrayResult result;
  int parity = 0;
  std::size_t strata = 0;
  file >> result.readout >> parity >> result.rows >> result.columns >> result.clocks >> strata;
  result.parity = parity != 0;
  for (std::size_t i = 0; i < strata && file; ++i) {
    StratumResult one;
    int part = 0;
    int element = 0;
    int repeated = 0;
    file >> part >> element >> repeated >> one.sites >> one.full_sites;
    one.part = static_cast<CircuitPart>(part);
    one.element = static_cast<Element>(element);
    one.repeated = static_cast<Repeated>(repeated);
    if (!read_counts(file, one.events) || !read_counts(file, one.stuck)) {
      return std::nullopt;
    }
    result.strata.push_back(one);
  }
  std::string last;
  file >> last;
  return last == "end" ? std::optional(result) : std::nullopt;
}

}  // namespace dtof
