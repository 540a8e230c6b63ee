// SPDX-License-Identifier: Apache-2.0
// What options hold that the parser does not look into: read-outs and their parameters, regions, scenes.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "command_line/options.hpp"
#include "common/readout_variant.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parameter_entry.hpp"
#include "dtof/scene/scene.hpp"
#include "run/region.hpp"

namespace {

void read(const std::uint8_t* data, std::size_t size) {
  if (size < 4) {
    return;
  }
  const std::string text(reinterpret_cast<const char*>(data) + 4, size - 4);
  const auto attempt = [](const std::function<void()>& parse) {
    try {
      parse();
    } catch (const dtof::InputError&) {  // the next one may take it
    }
  };
  attempt([&] { (void)dtof::parse_variant(text); });
  attempt([&] { (void)dtof::parse_columns(text, 200); });
  attempt([&] { (void)dtof::parse_rows(text, 160); });
  attempt([&] { (void)dtof::parse_scene(text); });
  dtof::ReadoutOptions options;
  options.readouts = text;
  const int np = data[0] - 128;
  for (const dtof::ParameterEntry& entry : dtof::parameter_entries()) {
    options.values = {{"NP", np}, {entry.name, data[1] - 128}};
    attempt([&] { (void)options.parameters(dtof::kAllReadouts); });
  }
  options.values = {{"NP", np}};
  options.code_gate = {data[2], data[3]};
  (void)options.parameters(dtof::kAllReadouts);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
