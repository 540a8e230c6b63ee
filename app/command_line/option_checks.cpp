// SPDX-License-Identifier: Apache-2.0
#include "command_line/option_checks.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/pipeline/frame_limits.hpp"

namespace dtof {
namespace {

/// `text` as a whole is a decimal number that T can hold.
template <typename T>
std::errc parse(std::string_view text, T& value) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

std::string whole_number_error(const std::string& text, bool negative_is_legal) {
  std::int64_t value = 0;
  std::uint64_t magnitude = 0;
  const bool negative = text.starts_with('-');
  const std::errc error = negative ? parse(text, value) : parse(text, magnitude);
  const std::size_t digits = text.find_first_not_of("+-");
  if (error == std::errc::result_out_of_range) {
    return fmt::format("'{}' is too large", text);
  }
  if (error != std::errc()) {
    return fmt::format("'{}' is not a whole number", text);
  }
  if (negative && !negative_is_legal) {
    return fmt::format("'{}' is negative", text);
  }
  if (text.size() > digits + 1 && text[digits] == '0') {
    return fmt::format("'{}' begins with 0; write a decimal number without", text);
  }
  return "";
}

/// -0 is 0.
void drop_sign_of_zero(std::string& text) {
  double value = 1.0;
  if (text.starts_with('-') && parse(text, value) == std::errc() && value == 0.0) {
    text.erase(0, 1);
  }
}

}  // namespace

std::string number_error(const std::string& text, const std::string& type) {
  if (type.starts_with("FLOAT")) {
    double value = 0.0;
    const std::errc error = parse(text, value);
    if (error == std::errc::result_out_of_range) {
      return fmt::format("'{}' is too large or too small a number", text);
    }
    return error == std::errc() && std::isfinite(value) ? "" : fmt::format("'{}' is not a number", text);
  }
  if (type.starts_with("INT") || type.starts_with("UINT")) {
    return whole_number_error(text, type.starts_with("INT"));
  }
  return "";
}

namespace {

/// The value of a number option, or what is wrong with the text.
std::string read_number(const std::string& text, double& value) {
  std::string error = number_error(text, "FLOAT");
  if (error.empty()) {
    (void)parse(text, value);
  }
  return error;
}

}  // namespace

CLI::Validator above_zero() {
  return {[](std::string& text) {
            double value = 0.0;
            const std::string error = read_number(text, value);
            return error.empty() && value <= 0.0 ? fmt::format("{} is not above 0", text) : error;
          },
          ""};
}

CLI::Validator not_negative() {
  return {[](std::string& text) {
            double value = 0.0;
            const std::string error = read_number(text, value);
            return error.empty() && value < 0.0 ? fmt::format("{} is negative", text) : error;
          },
          ""};
}

CLI::Validator within(double lowest, double highest, const std::string& reason) {
  return {[lowest, highest, reason](std::string& text) {
            double value = 0.0;
            if (std::string error = read_number(text, value); !error.empty()) {
              return error;
            }
            return value >= lowest && value <= highest ? std::string() : not_within(text, lowest, reason);
          },
          ""};
}

namespace {

/// Above 0, up to `most`, which is a second.
CLI::Validator up_to_a_second(double most, const std::string& unit) {
  return {[most, unit](std::string& text) {
            double value = 0.0;
            if (std::string error = read_number(text, value); !error.empty()) {
              return error;
            }
            return value <= 0.0   ? fmt::format("{} is not above 0", text)
                   : value > most ? fmt::format("{} is above {} {}, a second", text, most, unit)
                                  : std::string();
          },
          ""};
}

}  // namespace

CLI::Validator duration_ps() { return up_to_a_second(1e12, "ps"); }

CLI::Validator duration_ns() { return up_to_a_second(1e9, "ns"); }

CLI::Validator shift_ns() { return within(-1e9, 1e9, "1000000000 ns, a second"); }

CLI::Validator sensible_klux() { return within(0.0, kMostKlux, klux_reason()); }

CLI::Validator sensible_reflectivity() { return within(0.0, kMostReflectivity, reflectivity_reason()); }

CLI::Validator sensible_acquisitions() { return within(1.0, kMostAcquisitions, acquisitions_reason()); }

CLI::Validator sensible_frame_rate() { return within(0.001, 1e6, "1000000 frames/s"); }

CLI::Validator sensible_clock_mhz() { return within(0.001, 1e5, "100000 MHz"); }

void check_numbers(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    if (type.starts_with("FLOAT") || type.starts_with("INT") || type.starts_with("UINT")) {
      option->check([type](const std::string& text) { return number_error(text, type); });
      option->transform(CLI::Validator(
          [](std::string& text) {
            drop_sign_of_zero(text);
            return std::string();
          },
          ""));
    }
  }
  // An option group is a subcommand without a name.
  for (CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; })) {
    check_numbers(*group);
  }
}

void refuse_without_effect(const CLI::App& command, const std::string& option, const std::string& reason) {
  if (command.count(option) > 0) {
    throw InputError(fmt::format("{} has no effect: {}", option, reason));
  }
}

}  // namespace dtof
