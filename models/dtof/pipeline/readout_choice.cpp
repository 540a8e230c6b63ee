// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/readout_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using Parameters = ReadoutParameters;

struct Choice {
  std::string_view name;
  int (*get)(const Parameters&);
  void (*set)(Parameters&, int);
};

template <int Parameters::*Member>
constexpr Choice member(std::string_view name) {
  return {name, [](const Parameters& from) { return from.*Member; },
          [](Parameters& to, int value) { to.*Member = value; }};
}

constexpr std::array kChoices = std::to_array<Choice>({
    member<&Parameters::np>("NP"),
    member<&Parameters::slots>("SLOTS"),
    member<&Parameters::nb>("NB"),
    member<&Parameters::count_width>("COUNT_WIDTH"),
    member<&Parameters::pointer_step>("POINTER_STEP"),
    member<&Parameters::fraction_bits>("FRACTION_BITS"),
    member<&Parameters::confidence_width>("CONFIDENCE_WIDTH"),
    member<&Parameters::guard>("GUARD"),
    {"WINDOW_CENTRED", [](const Parameters& from) { return from.window_centred ? 1 : 0; },
     [](Parameters& to, int value) {
       if (value != 0 && value != 1) {
         throw InputError(fmt::format("WINDOW_CENTRED must be 0 or 1, is {}", value));
       }
       to.window_centred = value == 1;
     }},
    {"CELL_SHIFT", [](const Parameters& from) { return from.pool.cell_shift; },
     [](Parameters& to, int value) { to.pool.cell_shift = value; }},
});

bool belongs_to(Readout readout, std::string_view parameter) {
  return parameter == "NP" || parameter == "SLOTS" || has_parameter(readout, parameter);
}

const Choice& find_choice(Readout readout, std::string_view name) {
  const auto found = std::ranges::find(kChoices, name, &Choice::name);
  if (found == kChoices.end() || !belongs_to(readout, name)) {
    throw InputError(fmt::format("{} has no parameter {}; it has {}", readout_name(readout), name,
                                 fmt::join(parameter_names(readout), ", ")));
  }
  return *found;
}

}  // namespace

std::vector<std::string_view> parameter_names(Readout readout) {
  std::vector<std::string_view> names;
  for (const Choice& choice : kChoices) {
    if (belongs_to(readout, choice.name)) {
      names.push_back(choice.name);
    }
  }
  return names;
}

int get_parameter(const ReadoutParameters& parameters, std::string_view name) {
  return find_choice(parameters.readout, name).get(parameters);
}

void set_parameter(ReadoutParameters& parameters, std::string_view name, int value) {
  find_choice(parameters.readout, name).set(parameters, value);
}

}  // namespace dtof
