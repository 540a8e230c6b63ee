// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/condition.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "dtof/core/error.hpp"
#include "dtof/core/suggestion.hpp"
#include "dtof/sensor/preset_texts.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

constexpr std::string_view kFile = "conditions.toml";
constexpr std::string_view kSays = "says";

const toml::table& root() {
  static const toml::table table = toml::parse(conditions_text(), kFile);
  return table;
}

}  // namespace

const std::vector<Condition>& conditions() {
  static const std::vector<Condition> list = [] {
    std::vector<std::pair<toml::source_position, Condition>> found;
    for (const auto& [name, node] : root()) {
      found.push_back({name.source().begin,
                       {std::string(name.str()), node.as_table()->get(kSays)->value<std::string>().value()}});
    }
    std::ranges::sort(found, [](const auto& a, const auto& b) { return a.first.line < b.first.line; });
    std::vector<Condition> sorted;
    for (auto& [place, condition] : found) {
      sorted.push_back(std::move(condition));
    }
    return sorted;
  }();
  return list;
}

SensorModel under_condition(const SensorModel& sensor, std::string_view condition) {
  const toml::node* node = root().get(condition);
  if (node == nullptr) {
    std::vector<std::string_view> known;
    for (const Condition& each : conditions()) {
      known.push_back(each.name);
    }
    throw InputError(unknown_name("condition", condition, known));
  }
  toml::table part = *node->as_table();
  part.erase(kSays);
  std::ostringstream text;
  text << part;
  SensorModel changed = change_sensor(sensor, text.str(), kFile);
  changed.name = fmt::format("{}-{}", sensor.name, condition);
  return changed;
}

}  // namespace dtof
