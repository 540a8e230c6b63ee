// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace dtof {

/// Accepts a number from `lowest` to `highest`. The error text ends with `reason`, e.g. "to 200: direct
/// sunlight is about 130 klux".
CLI::Validator within(double lowest, double highest, const std::string& reason);

/// Accepts a plausible light level in klux; full sun is 100 to 130 klux.
CLI::Validator sensible_klux();
/// 1 is a white matt surface; a glint or a retroreflector is more.
/// Any number above 0, or of at least 0.
CLI::Validator above_zero();
CLI::Validator not_negative();
/// Accept times of recordings: a duration above 0 up to a second, in ps or ns, and a shift in ns of at most a
/// second.
CLI::Validator duration_ps();
CLI::Validator duration_ns();
CLI::Validator shift_ns();
CLI::Validator sensible_reflectivity();
/// Accepts a number of acquisitions up to kMostAcquisitions (pipeline/frame_limits.hpp).
CLI::Validator sensible_acquisitions();
/// Accept frames/s and MHz between those of any sensor and any array.
CLI::Validator sensible_frame_rate();
CLI::Validator sensible_clock_mhz();

/// Returns "" if an option of CLI11's type (FLOAT, INT or UINT) can hold `text`, else the reason, e.g. "'abc'
/// is not a number". Numbers are decimal and finite. (CLI11 alone would read 010 as 8 and -1 as 2^64 - 1.)
std::string number_error(const std::string& text, const std::string& type);

/// Adds number_error to every numeric option of the command, its subcommands and option groups.
void check_numbers(CLI::App& command);

/// Throws InputError "<option> has no effect: <reason>" if the user gave the option.
void refuse_without_effect(const CLI::App& command, const std::string& option, const std::string& reason);

}  // namespace dtof
