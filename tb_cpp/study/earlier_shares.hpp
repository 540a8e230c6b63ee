// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/csv_table.hpp"
#include "metrics/confidence_interval.hpp"

namespace dtof {

/// Shares of wrong pixels that `dtof-study pool` once printed of a read-out that is gone: the lines of its
/// pool.csv.
class EarlierShares {
 public:
  /// Throws InputError for a file that cannot be read, has not the columns klux, scene and estimator, or is
  /// of several estimators.
  explicit EarlierShares(const std::filesystem::path& file);

  [[nodiscard]] const std::string& estimator() const { return estimator_; }
  /// The share in a column such as above_3_percent, with its 95 % interval; none where the file has no line
  /// of the light and scene, or nothing in it. Throws InputError for a column that there is not and for a
  /// field that is no number.
  [[nodiscard]] std::optional<Estimate> share(double klux, std::string_view scene,
                                              std::string_view column) const;

 private:
  CsvTable table_;
  std::string estimator_;
  std::vector<double> klux_;
  std::vector<std::string> scenes_;
};

}  // namespace dtof
