// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/result_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {

void write_result_csv(const std::filesystem::path& path, std::span<const ResultRecord> records) {
  AtomicFile file(path);
  file.append(kResultCsvHeader);
  file.append("\n");
  for (const ResultRecord& record : records) {
    file.append(fmt::format("{},{},{},{},{}\n", record.column, record.row, record.result.code,
                            record.result.fraction, record.result.confidence));
  }
  file.commit();
}

std::vector<ResultRecord> read_result_csv(const std::filesystem::path& path) {
  struct Field {
    const char* name;
    std::uint64_t largest;
  };
  constexpr std::uint64_t kLargestIndex = std::numeric_limits<int>::max();
  constexpr std::uint64_t kLargestValue = std::numeric_limits<std::uint16_t>::max();
  constexpr std::array<Field, 5> kFields = {{{"column", kLargestIndex},
                                             {"row", kLargestIndex},
                                             {"code", kLargestValue},
                                             {"fraction", kLargestValue},
                                             {"confidence", kLargestValue}}};
  std::vector<ResultRecord> records;
  const std::string name = path.string();
  parse_integer_csv(
      name, read_file(path), kResultCsvHeader, [&](std::size_t line, std::span<const std::uint64_t> fields) {
        for (std::size_t i = 0; i < kFields.size(); ++i) {
          if (fields[i] > kFields.at(i).largest) {
            fail_at_line(
                name, line,
                fmt::format("{} {} is outside 0..{}", kFields.at(i).name, fields[i], kFields.at(i).largest));
          }
        }
        records.push_back({static_cast<int>(fields[0]),
                           static_cast<int>(fields[1]),
                           {static_cast<std::uint16_t>(fields[2]), static_cast<std::uint16_t>(fields[3]),
                            static_cast<std::uint16_t>(fields[4])}});
      });
  return records;
}

}  // namespace dtof
