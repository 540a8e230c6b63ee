// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fault_metrics/metric_study.hpp"

namespace dtof {

/// What an array's result depends on: options, netlist and program.
std::string result_key(const MetricStudyOptions& options, const std::filesystem::path& netlist);

/// Keeps the result of an array, so that an interrupted study continues behind it.
void store_result(const std::filesystem::path& path, const std::string& key, const ArrayResult& result);

/// The kept result; none if there is no file, if the file has another key, or if it is damaged.
std::optional<ArrayResult> stored_result(const std::filesystem::path& path, const std::string& key);

}  // namespace dtof
