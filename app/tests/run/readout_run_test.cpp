// SPDX-License-Identifier: Apache-2.0
#include "run/readout_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <vector>

#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kColumns = 5;
constexpr int kRows = 12;

/// A scene in which no two pixels are alike.
PhotonSource scene() {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 500;
  TargetMap targets(kColumns, kRows);
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      targets.at(column, row) = {.depth_m = 0.5 + 0.3 * row + 0.05 * column, .reflectivity = 1.0};
    }
  }
  return {sensor, targets, 14.0, 1};
}

TEST(ReadoutRun, APixelsResultDoesNotDependOnTheRegion) {
  const PhotonSource exact = scene();
  const Region region{.columns = {1, 2, 4}, .rows = {.first = 3, .count = 6}};
  for (const Fidelity fidelity : {Fidelity::kExact, Fidelity::kFast, Fidelity::kAnalytic}) {
    const std::unique_ptr<StreamSource> source = make_source(fidelity, exact);
    for (const bool streams_only : {false, true}) {
      RunSettings options;
      options.streams_only = streams_only;
      for (const Readout readout : kAllReadouts) {
        if (is_pool_readout(readout)) {
          continue;
        }
        SCOPED_TRACE(testing::Message() << fidelity_name(fidelity) << " " << readout_name(readout));
        const ReadoutParameters parameters = ReadoutParameters::defaults(readout, 10);
        const ReadoutRun whole =
            run_readout(*source, parameters, options, Region::whole(kColumns, kRows), "dtof");
        const ReadoutRun part = run_readout(*source, parameters, options, region, "dtof");
        ASSERT_EQ(part.results.size(), 18U);
        for (const ResultRecord& pixel : result_records(part.results, region)) {
          EXPECT_EQ(pixel.result,
                    whole.results[static_cast<std::size_t>(pixel.row * kColumns + pixel.column)])
              << pixel.column << " " << pixel.row;
        }
      }
    }
  }
}

TEST(ReadoutRun, APoolReadoutsArrayIsWholeAndDarkOutsideTheRegion) {
  const PhotonSource source = scene();
  const Region region{.columns = {2}, .rows = {.first = 3, .count = 6}};
  std::vector<ColumnStream> array(kColumns);
  for (int column = 0; column < kColumns; ++column) {
    const ColumnStream lit = source.column_rows(column, region.rows);
    for (int row = 0; row < kArrayRows; ++row) {
      array[static_cast<std::size_t>(column)].append_row(row >= 3 && row < 9 ? lit.row(row - 3)
                                                                             : std::span<const Detection>());
    }
  }
  for (const Readout readout : {Readout::kPoolPointer, Readout::kPoolPointerLean}) {
    const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
    const std::vector<PixelResult> whole = make_readout_model(parameters)->run_columns(array, 500)[2];
    const std::vector<PixelResult> expected(whole.begin() + 3, whole.begin() + 9);
    EXPECT_EQ(run_readout(source, parameters, {}, region, "dtof").results, expected);
  }
}

TEST(ReadoutRun, RefusesARegionOutsideTheSource) {
  const PhotonSource source = scene();
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kEzPointer, 10);
  const auto run = [&](const Region& region) { (void)run_readout(source, parameters, {}, region, "dtof"); };
  EXPECT_THAT([&] { run({.columns = {0}, .rows = {.first = 7, .count = 6}}); },
              ThrowsMessage<InputError>(HasSubstr("6 rows from row 7")));
  EXPECT_THAT([&] { run({.columns = {kColumns}, .rows = {.first = 0, .count = 1}}); },
              ThrowsMessage<InputError>(HasSubstr("column 5")));
}

}  // namespace
}  // namespace dtof
