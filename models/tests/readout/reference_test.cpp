// SPDX-License-Identifier: Apache-2.0
// Every model against the independent reference on random and adversarial streams.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "dtof/readout/model.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/reference_model.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {

// GoogleTest finds its printer by this name.
static void PrintTo(const PixelResult& result, std::ostream* out) {
  *out << fmt::format("code {} fraction {} confidence {}", result.code, result.fraction, result.confidence);
}

namespace {

class AgainstReference : public testing::TestWithParam<Readout> {};

// Everything but NP and NB, which the tests sweep.
ReadoutParameters random_parameters(Readout readout, int np, int nb, CounterRandom& random) {
  ReadoutParameters parameters = ReadoutParameters::defaults(readout, np);
  parameters.nb = nb;
  parameters.slots = 1 + pick(random, 4);
  parameters.count_width = 1 + pick(random, 12);
  parameters.pointer_step = 1 + pick(random, pick(random, 2) == 0 ? 3 : (1 << (np - 1)) - 1);
  parameters.fraction_bits = pick(random, std::min(8, 16 - np) + 1);
  parameters.confidence_width = pick(random, 9);
  parameters.guard = pick(random, pick(random, 2) == 0 ? 4 : (1 << np) + 1);
  parameters.window_centred = pick(random, 2) == 1;
  if (pick(random, 3) == 0) {
    parameters.time_gate = CodeGate{pick(random, 1 << np), pick(random, 1 << np)};
  }
  return parameters;
}

void expect_as_reference(const ReadoutParameters& parameters, std::uint32_t acquisitions,
                         CounterRandom& random) {
  ColumnStream column;
  std::vector<std::vector<Detection>> rows;
  for (const StreamKind kind : kStreamKinds) {  // one column: also shows that no row leaks into the next
    rows.push_back(make_stream(kind, parameters, acquisitions, random));
    column.append_row(rows.back());
  }
  const std::vector<PixelResult> results = make_readout_model(parameters)->run_column(column, acquisitions);
  ASSERT_EQ(results.size(), rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ASSERT_EQ(results[row], reference_result(parameters, rows[row], acquisitions))
        << parameters.to_string() << ", " << acquisitions << " acquisitions, stream "
        << stream_name(kStreamKinds[row]);
  }
  if (parameters.raw_bins() == 0) {
    return;
  }
  const auto histograms = make_readout_model(parameters)->run_raw_column(column, acquisitions);
  ASSERT_EQ(histograms.size(), rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ASSERT_EQ(histograms[row], reference_histogram(parameters, rows[row], acquisitions))
        << parameters.to_string() << ", " << acquisitions << " acquisitions, stream "
        << stream_name(kStreamKinds[row]);
  }
}

TEST_P(AgainstReference, EveryNpAndNb) {
  SCOPED_TRACE(test_seed_message());
  for (int np = 4; np <= 12; ++np) {
    for (int nb = 1; nb <= np; ++nb) {
      CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                           static_cast<std::uint32_t>(GetParam()), static_cast<std::uint32_t>(np * 16 + nb));
      for (const std::uint32_t acquisitions : {0U, 1U, 2U, 3U, 7U, 100U}) {
        expect_as_reference(random_parameters(GetParam(), np, nb, random), acquisitions, random);
        if (HasFatalFailure()) {
          return;
        }
      }
    }
  }
}

TEST_P(AgainstReference, NarrowestAndWidestTimestamps) {
  SCOPED_TRACE(test_seed_message());
  for (const int np : {3, 16}) {
    for (const int nb : {1, np / 2, np}) {
      CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                           static_cast<std::uint32_t>(GetParam()), static_cast<std::uint32_t>(np * 32 + nb));
      expect_as_reference(random_parameters(GetParam(), np, nb, random), 9, random);
    }
  }
}

TEST_P(AgainstReference, LongFrames) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                       static_cast<std::uint32_t>(GetParam()), 1U << 16U);
  for (const std::uint32_t acquisitions : {999U, 3333U, 33333U}) {
    ReadoutParameters parameters = ReadoutParameters::defaults(GetParam(), 10);
    parameters.fraction_bits = pick(random, 5);
    expect_as_reference(parameters, acquisitions, random);
  }
}

// Light that fills bins: a pulse over several of them, background alone, and both.
TEST_P(AgainstReference, FullBins) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream),
                       static_cast<std::uint32_t>(GetParam()), 1U << 17U);
  constexpr std::uint32_t kAcquisitions = 2000;
  for (int count_width = 1; count_width <= 8; ++count_width) {
    ReadoutParameters parameters = ReadoutParameters::defaults(GetParam(), 8);
    parameters.count_width = count_width;
    for (const auto& [signal, background] : {std::pair(0.9, 0.1), std::pair(0.0, 1.0), std::pair(0.5, 0.9)}) {
      ColumnStream column;
      std::vector<std::vector<Detection>> rows;
      for (int row = 0; row < 8; ++row) {
        const int middle = 20 + pick(random, 200);
        std::vector<Detection>& stream = rows.emplace_back();
        for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
          if (random.uniform() < signal) {
            stream.push_back(
                {acquisition, static_cast<Timestamp>(middle + pick(random, 7) + pick(random, 7))});
          }
          if (random.uniform() < background) {
            stream.push_back({acquisition, static_cast<Timestamp>(pick(random, parameters.no_detection()))});
          }
        }
        column.append_row(stream);
      }
      const auto results = make_readout_model(parameters)->run_column(column, kAcquisitions);
      for (std::size_t row = 0; row < rows.size(); ++row) {
        ASSERT_EQ(results[row], reference_result(parameters, rows[row], kAcquisitions))
            << parameters.to_string() << ", signal " << signal << ", background " << background << ", row "
            << row;
      }
    }
  }
}

/// pool_pointer_test has what pools pixels.
std::vector<Readout> single_pixel_readouts() {
  std::vector<Readout> readouts;
  std::ranges::copy_if(kAllReadouts, std::back_inserter(readouts), has_reference);
  return readouts;
}

INSTANTIATE_TEST_SUITE_P(SinglePixels, AgainstReference, testing::ValuesIn(single_pixel_readouts()),
                         [](const auto& suite) { return std::string(readout_name(suite.param)); });

}  // namespace
}  // namespace dtof
