// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/run_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>

#include "dtof/core/error.hpp"
#include "dtof/readout/model.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class RandomSource final : public StreamSource {
 public:
  explicit RandomSource(const ReadoutParameters& parameters, int rows_made = 5)
      : parameters_(parameters), rows_made_(rows_made) {}

  [[nodiscard]] int columns() const override { return 7; }
  [[nodiscard]] int rows() const override { return 5; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return 60; }
  [[nodiscard]] ColumnStream column(int index) const override {
    ++columns_made;
    ColumnStream stream;
    for (int row = 0; row < rows_made_; ++row) {
      CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                           static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(row));
      stream.append_row(make_stream(StreamKind::kBellAtBorder, parameters_, acquisitions(), random));
    }
    return stream;
  }

  mutable std::atomic<int> columns_made = 0;

 private:
  ReadoutParameters parameters_;
  int rows_made_;
};

TEST(RunFrame, RowMajorAndTheSameForEveryThreadCount) {
  SCOPED_TRACE(test_seed_message());
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 10);
  const RandomSource source(parameters);
  const std::vector<PixelResult> frame = run_frame(source, parameters, 1);
  ASSERT_EQ(frame.size(), 35U);
  for (int column = 0; column < 7; ++column) {
    const auto results = make_readout_model(parameters)->run_column(source.column(column), 60);
    for (int row = 0; row < 5; ++row) {
      EXPECT_EQ(frame[static_cast<std::size_t>(row * 7 + column)], results[static_cast<std::size_t>(row)]);
    }
  }
  EXPECT_EQ(run_frame(source, parameters, 0), frame);
  EXPECT_EQ(run_frame(source, parameters, 5), frame);
}

// Columns of an engine use each other's results, so that a part of a frame needs whole engines.
TEST(RunFrame, ColumnsThatUseEachOtherAreReadTogether) {
  SCOPED_TRACE(test_seed_message());
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPoolPointer, 10);
  parameters.pool.engine_columns = 4;
  const RandomSource source(parameters);
  std::vector<ColumnStream> columns(7);
  for (int column = 0; column < source.columns(); ++column) {
    columns.at(static_cast<std::size_t>(column)) = source.column(column);
  }
  const auto array = make_readout_model(parameters)->run_columns(columns, source.acquisitions());
  const std::vector<PixelResult> frame = run_frame(source, parameters, 2);
  const std::array<int, 3> some = {6, 1, 2};
  const std::vector<PixelResult> part = run_frame(source, parameters, 2, some);
  for (std::size_t row = 0; row < 5; ++row) {
    for (std::size_t column = 0; column < 7; ++column) {
      EXPECT_EQ(frame[row * 7 + column], array[column][row]) << "column " << column << ", row " << row;
    }
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(part[row * 3 + i], array[static_cast<std::size_t>(some[i])][row]) << "column " << some[i];
    }
  }
  source.columns_made = 0;
  (void)run_frame(source, parameters, 1, std::array<int, 1>{5});
  EXPECT_EQ(source.columns_made, 3) << "of the second engine, which has columns 4 to 6";
}

TEST(RunFrame, OnlyTheListedColumnsAreMade) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kFifh, 10);
  const RandomSource source(parameters);
  const std::vector<PixelResult> frame = run_frame(source, parameters);
  source.columns_made = 0;
  Progress progress("columns", 2);
  const std::array<int, 2> columns = {6, 2};
  const std::vector<PixelResult> part = run_frame(source, parameters, 2, columns, &progress);
  EXPECT_EQ(source.columns_made, 2);
  ASSERT_EQ(part.size(), 10U);
  for (std::size_t row = 0; row < 5; ++row) {
    EXPECT_EQ(part[row * 2], frame[row * 7 + 6]);
    EXPECT_EQ(part[row * 2 + 1], frame[row * 7 + 2]);
  }
}

TEST(RunFrame, RefusesWhatItCannotRead) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kFifh, 10);
  const RandomSource source(parameters);
  const std::array<int, 1> columns = {7};
  EXPECT_THAT([&] { run_frame(source, parameters, 1, columns); },
              ThrowsMessage<InputError>(HasSubstr("column 7 is outside the source's 0 to 6")));
  EXPECT_THAT([&] { run_frame(RandomSource(parameters, 4), parameters, 1); },
              ThrowsMessage<InputError>(HasSubstr("has 4 rows, its source says 5")));
  parameters.nb = 11;
  EXPECT_THAT([&] { run_frame(source, parameters); },
              ThrowsMessage<InputError>(HasSubstr("NB must be 1 to NP, not 11")));
}

}  // namespace
}  // namespace dtof
