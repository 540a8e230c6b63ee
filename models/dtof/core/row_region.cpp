// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/row_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/pixel_sampler.hpp"

namespace dtof {
namespace {

/// `Source` is StreamSource or SampledSource.
template <typename Source>
class RowRegion : public Source {
 public:
  RowRegion(const Source& source, RowRange rows) : source_(source), rows_(rows) {}

  [[nodiscard]] int columns() const override { return source_.columns(); }
  [[nodiscard]] int rows() const override { return rows_.count; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return source_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override { return source_.column_rows(index, rows_); }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange rows) const override {
    return source_.column_rows(index, {rows_.first + rows.first, rows.count});
  }

 protected:
  [[nodiscard]] const Source& source() const { return source_; }
  [[nodiscard]] int first_row() const { return rows_.first; }

 private:
  const Source& source_;
  RowRange rows_;
};

class DarkExcept final : public StreamSource {
 public:
  DarkExcept(const StreamSource& source, RowRange lit, int rows) : source_(source), lit_(lit), rows_(rows) {}

  [[nodiscard]] int columns() const override { return source_.columns(); }
  [[nodiscard]] int rows() const override { return rows_; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return source_.acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override {
    const ColumnStream lit = source_.column_rows(index, lit_);
    ColumnStream column;
    for (int row = 0; row < rows_; ++row) {
      const bool on = row >= lit_.first && row < lit_.first + lit_.count;
      column.append_row(on ? lit.row(row - lit_.first) : std::span<const Detection>());
    }
    return column;
  }

 private:
  const StreamSource& source_;
  RowRange lit_;
  int rows_;
};

void require_rows(RowRange rows, int available) {
  if (rows.first < 0 || rows.count < 1 || rows.count > available - rows.first) {
    throw InputError(fmt::format("{} rows from row {} are not within the source's 0 to {}", rows.count,
                                 rows.first, available - 1));
  }
}

class RegionSampler final : public PixelSampler {
 public:
  RegionSampler(std::unique_ptr<PixelSampler> sampler, int first_row)
      : sampler_(std::move(sampler)), first_row_(first_row) {}

  void start_pixel(int column, int row) override { sampler_->start_pixel(column, first_row_ + row); }
  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    return sampler_->draw(acquisitions, first, last);
  }

 private:
  std::unique_ptr<PixelSampler> sampler_;
  int first_row_;
};

class SampledRowRegion final : public RowRegion<SampledSource> {
 public:
  using RowRegion::RowRegion;

  [[nodiscard]] std::unique_ptr<PixelSampler> pixel_sampler() const override {
    return std::make_unique<RegionSampler>(source().pixel_sampler(), first_row());
  }
};

}  // namespace

std::unique_ptr<StreamSource> row_region(const StreamSource& source, RowRange rows) {
  require_rows(rows, source.rows());
  if (const auto* sampled = dynamic_cast<const SampledSource*>(&source)) {
    return std::make_unique<SampledRowRegion>(*sampled, rows);
  }
  return std::make_unique<RowRegion<StreamSource>>(source, rows);
}

std::unique_ptr<StreamSource> dark_except(const StreamSource& source, RowRange lit, int rows) {
  require_rows(lit, std::min(source.rows(), rows));
  return std::make_unique<DarkExcept>(source, lit, rows);
}

}  // namespace dtof
