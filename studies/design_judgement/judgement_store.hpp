// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "design_judgement/design_judgement.hpp"

namespace dtof {

/// Writes a judgement as a CSV of one line.
void store_judgement(const std::filesystem::path& file, const SensorJudgement& judgement);
/// Reads what store_judgement wrote; every number is equal.
SensorJudgement stored_judgement(const std::filesystem::path& file);

}  // namespace dtof
