// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/kept_streams.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>

#include "dtof/core/parallel.hpp"

namespace dtof {
namespace {

constexpr int kColumns = 4;
constexpr int kRows = 3;
constexpr int kDetections = 5;  // of a pixel

/// Counts how often it is asked.
class CountingSource final : public StreamSource {
 public:
  [[nodiscard]] int columns() const override { return kColumns; }
  [[nodiscard]] int rows() const override { return kRows; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return kDetections; }
  [[nodiscard]] ColumnStream column(int index) const override {
    ++drawn_;
    ColumnStream stream;
    for (int row = 0; row < kRows; ++row) {
      for (std::uint32_t acquisition = 0; acquisition < kDetections; ++acquisition) {
        stream.append({acquisition, static_cast<Timestamp>(10 * index + row)});
      }
      stream.finish_row();
    }
    return stream;
  }
  [[nodiscard]] int drawn() const { return drawn_; }

 private:
  mutable std::atomic<int> drawn_ = 0;
};

TEST(KeptStreams, AreTheSourcesAndDrawnOnce) {
  const CountingSource source;
  const KeptStreams kept(source);
  EXPECT_EQ(kept.columns(), kColumns);
  EXPECT_EQ(kept.rows(), kRows);
  EXPECT_EQ(kept.acquisitions(), source.acquisitions());
  for (int reader = 0; reader < 3; ++reader) {
    parallel_for(kColumns, 2, [&](std::size_t i) {
      const int index = static_cast<int>(i);
      EXPECT_EQ(kept.column(index).row(2)[0].timestamp, 10 * index + 2);
    });
  }
  EXPECT_EQ(source.drawn(), kColumns);
}

TEST(KeptStreams, OtherRowsAreDrawnForThemselves) {
  const CountingSource source;
  const CountingSource same;
  const KeptStreams kept(source);
  const RowRange middle{.first = 1, .count = 1};
  EXPECT_EQ(kept.column_rows(0, middle), same.column_rows(0, middle));
  EXPECT_EQ(kept.column(0), same.column(0));
  EXPECT_EQ(kept.column_rows(0, middle), same.column_rows(0, middle));
  EXPECT_EQ(source.drawn(), 2);
}

TEST(KeptStreams, AForgottenColumnIsDrawnAnewAndItsMemoryIsFree) {
  const CountingSource source;
  constexpr std::size_t kOneColumn = kRows * kDetections * sizeof(Detection);
  KeptStreams kept(source, kOneColumn);
  const ColumnStream first = kept.column(1);
  kept.drop(1);
  kept.drop(1);
  EXPECT_EQ(kept.column(1), first);
  EXPECT_EQ(source.drawn(), 2);
  kept.drop(1);
  (void)kept.column(2);
  (void)kept.column(2);
  EXPECT_EQ(source.drawn(), 3) << "there is memory for one column";
}

TEST(KeptStreams, MemoryIsBounded) {
  const CountingSource source;
  const std::size_t column = sizeof(Detection) * kRows * kDetections;
  const KeptStreams kept(source, 2 * column + column / 2);
  for (int reader = 0; reader < 2; ++reader) {
    for (int index = 0; index < kColumns; ++index) {
      EXPECT_EQ(kept.column(index).row(0)[0].timestamp, 10 * index);
    }
  }
  EXPECT_EQ(source.drawn(), kColumns + 2);
}

}  // namespace
}  // namespace dtof
