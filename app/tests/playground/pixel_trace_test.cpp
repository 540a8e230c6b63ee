// SPDX-License-Identifier: Apache-2.0
#include "playground/pixel_trace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "dtof/frame/array_rows.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "playground/session.hpp"

namespace dtof {
namespace {

using testing::Contains;
using testing::Field;
using testing::IsEmpty;

constexpr int kColumns = 6;
constexpr int kRows = 8;

PlaygroundRequest small_plane() {
  PlaygroundRequest request;
  request.scene = "plane";
  request.columns = kColumns;
  request.rows = kRows;
  request.acquisitions = 800;
  request.seed = 3;
  return request;
}

/// After the last acquisition a pixel's state is its result in the frame, for every read-out.
TEST(PixelTrace, EndsWithTheFrame) {
  PlaygroundRequest request = small_plane();
  for (const Readout readout : kAllReadouts) {
    request.readouts.emplace_back(readout_name(readout));
  }
  PlaygroundSession session(request);
  session.calibrate();
  for (int column = 0; column < kColumns; ++column) {
    session.read_column(column);
  }
  for (const auto& [column, row] : {std::pair{0, 0}, std::pair{4, 7}, std::pair{5, 3}}) {
    const std::unique_ptr<PixelTrace> trace = session.trace(column, row);
    for (std::size_t r = 0; r < request.readouts.size(); ++r) {
      SCOPED_TRACE(request.readouts[r]);
      PixelResult expected =
          session.frame(r)
              .results[static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column)];
      PixelResult last = trace->result(session.readout(r), 800);
      last.second = expected.second;  // the trace knows the rival, too
      EXPECT_EQ(last, expected);
      EXPECT_EQ(trace->candidates(session.readout(r), 800).size(),
                is_pool_readout(session.readout(r).readout)
                    ? static_cast<std::size_t>(session.readout(r).pool.labels)
                    : 0U);
    }
  }
}

/// The pointer after some acquisitions is that of a frame in which nothing else was detected.
TEST(PixelTrace, EndsTheLight) {
  PlaygroundRequest request = small_plane();
  request.readouts = {"ezpointer", "sifh", "poolpointer"};
  const PlaygroundSession session(request);
  const std::unique_ptr<PixelTrace> trace = session.trace(2, 5);
  for (const std::size_t r : {0U, 1U}) {
    EXPECT_EQ(trace->result(session.readout(r), 0).confidence, 0) << request.readouts[r];
  }
  EXPECT_NE(trace->result(session.readout(0), 100).code, trace->result(session.readout(0), 800).code);
  EXPECT_THAT(trace->candidates(session.readout(1), 800), IsEmpty());
}

/// Cells that pixels of each group chose in the model, by pair of columns.
PoolPrior chosen_cells(const StreamSource& array, const ReadoutParameters& readout) {
  std::vector<PoolPrior> priors;
  ColumnStream stream;
  run_pool_pointer(
      kColumns, [&](int column) -> const ColumnStream& { return stream = array.column(column); }, readout.np,
      array.acquisitions(), pool_pointer_parameters(readout), &priors);
  return priors.at(0);
}

/// The cells that the model's pixels chose are among the candidates, for read-outs whose groups differ.
TEST(PixelTrace, HasTheCandidatesOfTheModel) {
  PlaygroundRequest request = small_plane();
  request.readouts = {"poolpointer", "poolpointer-lean"};
  const PlaygroundSession session(request);
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 800;
  const PhotonSource scene(sensor, make_scene(Scene::kPlane, {.columns = kColumns, .rows = kRows}), 14.0, 3);
  const ArrayRows array = array_rows(scene, {0, kRows}, Readout::kPoolPointer);
  const std::vector<PoolPrior> chosen = {chosen_cells(*array.source, session.readout(0)),
                                         chosen_cells(*array.source, session.readout(1))};
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      const std::unique_ptr<PixelTrace> trace = session.trace(column, row);
      for (std::size_t r = 0; r < chosen.size(); ++r) {
        const ReadoutParameters& readout = session.readout(r);
        const int height = array.source->rows() / readout.pool.group_size;
        const int group = column / 2 * height + row / readout.pool.group_size;
        const std::vector<PoolCandidate> candidates = trace->candidates(readout, 800);
        for (const std::int32_t cell : chosen[r].at(static_cast<std::size_t>(group))) {
          EXPECT_THAT(candidates, Contains(Field(&PoolCandidate::cell, cell))) << column << ", " << row;
        }
      }
    }
  }
}

/// A pixel with a clear best score starts its pointer at that candidate.
TEST(PixelTrace, HasTheScoresOfTheModel) {
  PlaygroundRequest request = small_plane();
  request.readouts = {"poolpointer"};
  const PlaygroundSession session(request);
  const ReadoutParameters& readout = session.readout(0);
  const PoolSchedule schedule(800, readout.pool);
  int clear = 0;
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      const std::unique_ptr<PixelTrace> trace = session.trace(column, row);
      std::vector<PoolCandidate> candidates = trace->candidates(readout, schedule.track_end);
      EXPECT_EQ(candidates, trace->candidates(readout, 800));
      std::ranges::sort(candidates,
                        [](const PoolCandidate& a, const PoolCandidate& b) { return a.score > b.score; });
      if (candidates[0].score - candidates[1].score >= 8) {
        ++clear;
        const int cell = trace->result(readout, schedule.track_end).code / 8;
        EXPECT_LE(std::abs(cell - candidates[0].cell), 5) << column << ", " << row;
      }
    }
  }
  EXPECT_GE(clear, 10);
}

}  // namespace
}  // namespace dtof
