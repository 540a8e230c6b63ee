// SPDX-License-Identifier: Apache-2.0
// Worked examples and corner cases whose results are known by hand.
#include "dtof/readout/model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// `slots` codes per acquisition, row 0 of one column.
ColumnStream stream_of(const std::vector<Timestamp>& codes, std::uint32_t slots = 1) {
  ColumnStream column;
  std::uint32_t index = 0;
  for (const Timestamp code : codes) {
    column.append({index / slots, code});
    ++index;
  }
  column.finish_row();
  return column;
}

PixelResult run(const ReadoutParameters& parameters, const ColumnStream& column, std::uint32_t acquisitions) {
  return make_readout_model(parameters)->run_column(column, acquisitions).front();
}

PixelResult run(const ReadoutParameters& parameters, const std::vector<Timestamp>& codes) {
  return run(parameters, stream_of(codes), static_cast<std::uint32_t>(codes.size()));
}

ReadoutParameters thesis_table_3() {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 4);
  parameters.nb = 3;
  return parameters;
}

TEST(SifhModel, ThesisTables3And4) {
  const PixelResult result = run(thesis_table_3(), stream_of({11, 9, 11, 15, 10, 10, 15, 11}, 2), 4);
  EXPECT_EQ(result.code, 10U);
  EXPECT_EQ(result.confidence, 2U);
}

TEST(SifhModel, ThesisWindowIsAbove6UpTo14) {
  const auto second_measurement = [](Timestamp code) {
    return run(thesis_table_3(), stream_of({11, 9, 11, 15, code, 15, 15, 15}, 2), 4);
  };
  for (Timestamp code = 0; code < 15; ++code) {
    const PixelResult result = second_measurement(code);
    const bool kept = code > 6 && code <= 14;
    EXPECT_EQ(result.confidence, kept ? 1U : 0U) << code;
    EXPECT_EQ(result.code, kept ? code : 7U) << code;
  }
}

TEST(SifhModel, CentredWindowShiftsByHalfACoarseBin) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 10);  // NB 6, coarse bins of 16
  const auto kept = [&parameters](Timestamp code) {
    return run(parameters, {325, code}).confidence == 1;  // P = 20, edge 320
  };
  EXPECT_FALSE(kept(288));
  EXPECT_TRUE(kept(289));
  EXPECT_TRUE(kept(352));
  EXPECT_FALSE(kept(353));
  parameters.window_centred = true;
  EXPECT_FALSE(kept(295));
  EXPECT_TRUE(kept(296));
  EXPECT_TRUE(kept(359));
  EXPECT_FALSE(kept(360));
}

TEST(SifhModel, ThresholdsAreSignedAtBothEnds) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 10);
  EXPECT_EQ(run(parameters, {3, 5}).code, 5U) << "TH- is -32";
  EXPECT_EQ(run(parameters, {3, 1022}).confidence, 0U) << "the window does not wrap";
  EXPECT_EQ(run(parameters, {1022, 1022}).code, 1022U) << "TH+ is 1040";
  EXPECT_EQ(run(parameters, {1022, 3}).confidence, 0U);
}

TEST(FifhModel, FineHistogramOfExactlyThePeakBin) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kFifh, 10);
  EXPECT_EQ(run(parameters, {100, 101, 700, 127, 127, 128}).code, 127U);
  EXPECT_EQ(run(parameters, {100, 101, 700, 95, 128, 200}).code, 96U) << "nothing kept: the bin's first code";
}

TEST(FifhModel, CoarseBellAcrossABorderGoesToTheHigherCount) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kFifh, 10);
  EXPECT_EQ(run(parameters, {126, 127, 128, 129, 130, 127, 127, 127, 128, 128}).code, 128U);
  EXPECT_EQ(run(parameters, {126, 127, 128, 129, 127, 127, 128, 128}).code, 127U) << "a tie goes left";
}

TEST(ThreeStepsModel, ZoomsThreeBitsAStep) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kThreeSteps, 10);
  // 701 is 0b101'011'110'1; the 3s are outside the prefix of the step they stand in.
  const auto second_measurement = [&parameters](const std::vector<Timestamp>& codes) {
    std::vector<Timestamp> frame = {701, 701, 3, 701, 701, 3};
    frame.insert(frame.end(), codes.begin(), codes.end());
    return run(parameters, frame);
  };
  const PixelResult result = second_measurement({3, 708, 709, 709, 709, 708});
  EXPECT_EQ(result.code, 708U);
  EXPECT_EQ(result.confidence, 2U);
  for (Timestamp code = 680; code < 720; ++code) {
    const bool kept = code >= 693 && code <= 708;  // b = 700: b - 7 to b + 8
    EXPECT_EQ(second_measurement({3, 3, 3, 3, 3, code}).confidence, kept ? 1U : 0U) << code;
  }
}

TEST(PifhModel, LaterRunWinsOnlyWithALargerCount) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kPifh, 4);
  parameters.nb = 3;
  EXPECT_EQ(run(parameters, {5, 5, 9, 9}).code, 5U);
  EXPECT_EQ(run(parameters, {5, 12, 9, 9}).code, 9U);
  EXPECT_EQ(run(parameters, {9, 9, 5, 5}).code, 0U) << "each run sees only its own partition";
}

TEST(PifhModel, WithOnePartitionIsTheHistogram) {
  ReadoutParameters pifh = ReadoutParameters::defaults(Readout::kPifh, 8);
  pifh.nb = 8;
  const std::vector<Timestamp> codes = {1, 200, 3, 200, 255, 3, 254};
  EXPECT_EQ(run(pifh, codes), run(ReadoutParameters::defaults(Readout::kHistogram, 8), codes));
}

TEST(HistogramModel, TieFullBinAndNoDetection) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHistogram, 10);
  parameters.count_width = 2;
  EXPECT_EQ(run(parameters, {9, 9, 4, 4}).code, 4U);
  EXPECT_EQ(run(parameters, {9, 9, 4, 9, 4, 4, 4}).code, 9U) << "full first";
  EXPECT_EQ(run(parameters, {1023, 1023, 1023, 1022}).code, 1022U);
}

TEST(HisPointerModel, Version1StartsAtTheCoarseBinsCentreAndSeesEverything) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer1, 10);
  EXPECT_EQ(run(parameters, {100, 1023}).code, 112U);
  EXPECT_EQ(run(parameters, {100, 600}).code, 113U);
  EXPECT_EQ(run(parameters, {100, 700}).code, 111U) << "the way round is shorter";
}

TEST(HisPointerModel, Version2SeesOnlyItsWindow) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer, 10);
  // P = 3, c = 112, SB = 16 + 46.
  EXPECT_EQ(run(parameters, {100, 50}).code, 112U);
  EXPECT_EQ(run(parameters, {100, 51}).code, 111U);
  EXPECT_EQ(run(parameters, {100, 174}).code, 113U);
  EXPECT_EQ(run(parameters, {100, 175}).code, 112U);
  EXPECT_EQ(run(parameters, {0, 1000}).code, 16U) << "no wrap in the filter";
}

/// As many detections of a bin's first code as `counts` has for it, one an acquisition.
std::vector<Timestamp> codes_of(const std::vector<int>& counts, int bin_codes) {
  std::vector<Timestamp> codes;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    codes.insert(codes.end(), static_cast<std::size_t>(counts[bin]),
                 static_cast<Timestamp>(static_cast<int>(bin) * bin_codes));
  }
  return codes;
}

ReadoutParameters eight_bins(int fraction_bits) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kCoarseHistogram, 6);
  parameters.nb = 3;
  parameters.fraction_bits = fraction_bits;
  return parameters;
}

TEST(CoarseHistogramModel, PlaceBetweenTheBinsOfTheHighestPair) {
  const auto read = [](const std::vector<int>& counts, int fraction_bits) {
    return run(eight_bins(fraction_bits), codes_of(counts, 8));
  };
  // Pairs 1, 5, 8, 6, 2: the edge is code 24, the lean 1 of a height of 8, so 2 / 3 * 1 / 8 * 8 codes above
  // it.
  EXPECT_EQ(read({0, 1, 4, 4, 2, 0, 0, 0}, 2), (PixelResult{24, 2, 8}));
  EXPECT_EQ(read({0, 1, 4, 4, 2, 0, 0, 0}, 0), (PixelResult{24, 0, 8}));
  // The mirror image: as far below the edge, rounded away from it.
  EXPECT_EQ(read({0, 2, 4, 4, 1, 0, 0, 0}, 2), (PixelResult{23, 1, 8}));
  EXPECT_EQ(read({0, 0, 4, 4, 0, 0, 0, 0}, 4), (PixelResult{24, 0, 8})) << "in the middle";
  // One bin alone: the lower of two equal pairs, whose pulse leans on what is behind it, 2 / 3 of a bin.
  EXPECT_EQ(read({0, 0, 0, 6, 0, 0, 0, 0}, 2), (PixelResult{29, 1, 6}));
}

TEST(CoarseHistogramModel, BackgroundIsTheMeanOfTheOtherPairs) {
  // The pair has 20, the others 6 * 4 = 24, which is 24 / (8 / 2) = 6 a pair: a height of 14, a lean of 4.
  // 2 / 3 * 4 / 14 of 8 codes are 1.52.
  EXPECT_EQ(run(eight_bins(4), codes_of({4, 4, 4, 10, 10, 8, 4, 4}, 8)).confidence, 13);
  EXPECT_EQ(run(eight_bins(2), codes_of({3, 3, 3, 10, 10, 7, 4, 4}, 8)), (PixelResult{33, 2, 14}));
  // A height of 18 - 54 / 4 = 5 and a lean of 9, for the pair before the first one has one bin: no more than
  // 2 / 3 of a bin.
  EXPECT_EQ(run(eight_bins(4), codes_of({9, 9, 9, 9, 9, 9, 9, 9}, 8)), (PixelResult{13, 5, 5}));
}

TEST(CoarseHistogramModel, BeyondEitherEndThereIsNothing) {
  EXPECT_EQ(run(eight_bins(0), codes_of({5, 3, 0, 0, 0, 0, 0, 0}, 8)), (PixelResult{6, 0, 8}))
      << "the pair before the first one has one bin";
  EXPECT_EQ(run(eight_bins(0), codes_of({0, 0, 0, 0, 0, 0, 3, 5}, 8)), (PixelResult{57, 0, 8}));
}

TEST(CoarseHistogramModel, ConfidenceStaysInItsBits) {
  ReadoutParameters parameters = eight_bins(0);
  parameters.count_width = 3;
  EXPECT_EQ(run(parameters, codes_of({0, 0, 6, 7, 0, 0, 0, 0}, 8)), (PixelResult{24, 0, 7}));
  EXPECT_EQ(run(parameters, codes_of({0, 0, 3, 9, 2, 0, 0, 0}, 8)),
            run(parameters, codes_of({0, 0, 3, 7, 0, 0, 0, 0}, 8)))
      << "frozen";
  EXPECT_EQ(run(parameters, codes_of({0, 0, 3, 3, 0, 0, 0, 0}, 8)).confidence, 6);
  EXPECT_EQ(run(parameters, codes_of({0, 0, 4, 4, 0, 0, 0, 0}, 8)).confidence, 7);
}

// Where the factor of two thirds comes from: the thesis's pulse, 2 ns of 45 ns, without noise.
TEST(CoarseHistogramModel, AGaussianPulseIsPlacedToAHundredthOfABin) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kCoarseHistogram, 10);
  parameters.count_width = 16;
  constexpr double kBin = 32.0;
  constexpr double kSigma = 2.0 / 45.0 * 1024.0 / 2.3548;
  for (double middle = 400.0; middle < 464.0; middle += 1.0) {
    std::vector<int> counts;
    for (int bin = 0; bin < 32; ++bin) {
      const auto below = [&](double code) {
        return 0.5 * std::erfc((middle - code) / (kSigma * std::sqrt(2.0)));
      };
      counts.push_back(
          static_cast<int>(std::lround(30000.0 * (below((bin + 1) * kBin) - below(bin * kBin)))));
    }
    const PixelResult result = run(parameters, codes_of(counts, 32));
    EXPECT_NEAR(result.code + (result.fraction + 0.5) / 4.0, middle, 0.01 * kBin) << middle;
  }
}

TEST(EzPointerModel, PingPongAcrossThePointer) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kEzPointer, 10);
  const std::vector<Timestamp> codes = {513, 511, 513, 511, 513, 511};
  EXPECT_EQ(run(parameters, codes).code, 512U);
  EXPECT_EQ(run(parameters, stream_of({600, 600}, 2), 1).code, 514U) << "both slots of one acquisition count";
}

TEST(EmptyFrame, EveryReadoutHasItsDefinedResult) {
  const std::map<Readout, int> codes = {
      {Readout::kEzPointer, 512}, {Readout::kHisPointer1, 16}, {Readout::kHisPointer, 16},
      {Readout::kSifh, 0},        {Readout::kFifh, 0},         {Readout::kThreeSteps, 0},
      {Readout::kPifh, 0},        {Readout::kHistogram, 0},    {Readout::kCoarseHistogram, 32}};
  for (const auto& [readout, code] : codes) {
    const ReadoutParameters parameters = ReadoutParameters::defaults(readout, 10);
    const PixelResult expected{static_cast<std::uint16_t>(code), 0, 0};
    EXPECT_EQ(run(parameters, stream_of({}), 0), expected) << readout_name(readout);
    EXPECT_EQ(run(parameters, stream_of({}), 33333), expected) << readout_name(readout);
    EXPECT_EQ(run(parameters, stream_of({1023}), 1), expected) << readout_name(readout);
  }
}

// Whatever was measured, the code is one that can be measured, 0 to M - 2, without a limit at the upper end:
// all coarse peaks and all fine peaks, empty ones included.
void expect_every_code_in_the_range(const ReadoutParameters& parameters) {
  SCOPED_TRACE(parameters.to_string());
  const int no_detection = parameters.no_detection();
  const auto model = make_readout_model(parameters);
  // Three acquisitions in measurement 1, one for each of the three steps.
  std::vector<Timestamp> codes(6, static_cast<Timestamp>(no_detection));
  const bool three_steps = parameters.readout == Readout::kThreeSteps;
  for (int first = 0; first <= no_detection; ++first) {
    for (int second = 0; second <= (three_steps ? no_detection : 0); ++second) {
      for (int third = 0; third <= (three_steps ? no_detection : 0); ++third) {
        for (int fine = 0; fine <= no_detection; ++fine) {
          codes[0] = static_cast<Timestamp>(first);
          codes[1] = static_cast<Timestamp>(three_steps ? second : first);
          codes[2] = static_cast<Timestamp>(three_steps ? third : first);
          codes[3] = static_cast<Timestamp>(fine);
          const PixelResult result = model->run_column(stream_of(codes), 6).front();
          ASSERT_LT(result.code, no_detection) << first << " " << second << " " << third << " " << fine;
          ASSERT_TRUE(result.confidence == 0 || result.code == fine);
        }
      }
    }
  }
}

TEST(WindowReadouts, NoCodeBeyondTheRange) {
  for (int np = 3; np <= 7; ++np) {
    for (int nb = 1; nb <= np; ++nb) {
      for (const bool centred : {false, true}) {
        ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, np);
        parameters.nb = nb;
        parameters.window_centred = centred;
        expect_every_code_in_the_range(parameters);
      }
    }
  }
  for (int np = 3; np <= 4; ++np) {
    expect_every_code_in_the_range(ReadoutParameters::defaults(Readout::kThreeSteps, np));
  }
}

TEST(IllegalParameters, RefusedWithASentence) {
  struct Case {
    void (*spoil)(ReadoutParameters&);
    std::string message;
  };
  const std::vector<Case> cases = {
      {[](ReadoutParameters& p) { p.np = 2; }, "NP must be 3 to 16, not 2"},
      {[](ReadoutParameters& p) { p.np = 17; }, "NP must be 3 to 16, not 17"},
      {[](ReadoutParameters& p) { p.nb = 0; }, "NB must be 1 to NP, not 0"},
      {[](ReadoutParameters& p) { p.nb = 11; }, "NB must be 1 to NP, not 11"},
      {[](ReadoutParameters& p) { p.slots = 0; }, "SLOTS must be 1 to 16, not 0"},
      {[](ReadoutParameters& p) { p.count_width = 0; }, "COUNT_WIDTH must be 1 to 16, not 0"},
      {[](ReadoutParameters& p) { p.count_width = 17; }, "COUNT_WIDTH must be 1 to 16, not 17"},
      {[](ReadoutParameters& p) { p.pointer_step = 0; }, "POINTER_STEP must be 1 to 2^(NP-1) - 1, not 0"},
      {[](ReadoutParameters& p) { p.pointer_step = 512; }, "POINTER_STEP must be 1 to 2^(NP-1) - 1, not 512"},
      {[](ReadoutParameters& p) { p.fraction_bits = 7; },
       "FRACTION_BITS must be 0 to 8 and NP + FRACTION_BITS at most 16, not 7"},
      {[](ReadoutParameters& p) { p.confidence_width = 9; }, "CONFIDENCE_WIDTH must be 0 to 8, not 9"},
      {[](ReadoutParameters& p) {
         p.time_gate = CodeGate{0, 1024};
       },
       "gate end must be 0 to 1023, not 1024"},
      {[](ReadoutParameters& p) {
         p.time_gate = CodeGate{-1, 7};
       },
       "gate begin must be 0 to 1023, not -1"},
  };
  const std::vector<Case> pool_cases = {
      {[](ReadoutParameters& p) { p.np = 7; }, "NP must be 8 to 16, not 7"},
      {[](ReadoutParameters& p) { p.np = 17; }, "NP must be 8 to 16, not 17"},
      {[](ReadoutParameters& p) { p.nb = 4; }, "NB must be 5, not 4"},
      {[](ReadoutParameters& p) { p.slots = 1; }, "SLOTS must be 2 to 4, not 1"},
      {[](ReadoutParameters& p) { p.slots = 5; }, "SLOTS must be 2 to 4, not 5"},
      {[](ReadoutParameters& p) { p.count_width = 3; }, "COUNT_WIDTH must be 4 to 8, not 3"},
      {[](ReadoutParameters& p) { p.count_width = 9; }, "COUNT_WIDTH must be 4 to 8, not 9"},
      {[](ReadoutParameters& p) { p.fraction_bits = 5; }, "FRACTION_BITS must be 16 - NP, not 5"},
      {[](ReadoutParameters& p) {
         p.time_gate = CodeGate{0, 1024};
       },
       "gate end must be 0 to 1023, not 1024"},
      {[](ReadoutParameters& p) {
         p.time_gate = CodeGate{-1, 7};
       },
       "gate begin must be 0 to 1023, not -1"},
  };
  for (const Readout readout : kAllReadouts) {
    SCOPED_TRACE(readout_name(readout));
    for (const Case& bad : is_pool_readout(readout) ? pool_cases : cases) {
      ReadoutParameters parameters = ReadoutParameters::defaults(readout, 10);
      bad.spoil(parameters);
      EXPECT_THAT([&] { (void)make_readout_model(parameters); },
                  ThrowsMessage<InputError>(HasSubstr(bad.message)));
    }
  }
}

// Timestamps of a stream as a sampler hands them out.
class StreamSampler final : public PixelSampler {
 public:
  explicit StreamSampler(const ColumnStream& stream) : stream_(stream) {}
  void start_pixel(int /*column*/, int row) override {
    detections_ = stream_.row(row);
    end_ = 0;
  }
  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    end_ += acquisitions;
    drawn_.clear();
    for (; !detections_.empty() && detections_.front().acquisition < end_;
         detections_ = detections_.subspan(1)) {
      const int timestamp = detections_.front().timestamp;
      if (timestamp >= first && timestamp < last) {
        drawn_.push_back(detections_.front().timestamp);
      }
    }
    return drawn_;
  }

 private:
  const ColumnStream& stream_;
  std::span<const Detection> detections_;
  std::uint32_t end_ = 0;
  std::vector<Timestamp> drawn_;
};

// Twice the light at 3 as at 11; 12 is the gate's end, 8 its begin.
TEST(TimeGate, WhatIsOutsideDoesNotExist) {
  // Of 4 bits; a pool read-out has at least 8.
  const std::vector<Timestamp> all = {3, 11, 3, 7, 12, 3, 8, 11, 3, 3, 11, 3, 7, 12, 3, 11, 8, 11, 11, 3};
  for (const Readout readout : kAllReadouts) {
    SCOPED_TRACE(readout_name(readout));
    const int np = is_pool_readout(readout) ? 8 : 4;
    ReadoutParameters parameters = ReadoutParameters::defaults(readout, np);
    const int begin = 8 << (np - 4);
    const int end = 12 << (np - 4);
    std::vector<Timestamp> codes;
    std::vector<Timestamp> kept;
    for (const Timestamp code : all) {
      const int scaled = code << (np - 4);
      const bool counts = scaled >= begin && scaled < end;
      codes.push_back(static_cast<Timestamp>(scaled));
      kept.push_back(static_cast<Timestamp>(counts ? scaled : parameters.no_detection()));
    }
    const ColumnStream stream = stream_of(codes);
    const ColumnStream inside = stream_of(kept);
    const PixelResult expected = run(parameters, inside, 20);
    EXPECT_NE(run(parameters, stream, 20), expected);
    parameters.time_gate = CodeGate{begin, end};
    EXPECT_EQ(run(parameters, stream, 20), expected);
    if (!is_pool_readout(readout)) {  // it reads streams alone
      StreamSampler sampler(stream);
      std::vector<PixelResult> sampled(1);
      make_readout_model(parameters)->run_sampled_column(sampler, 0, 20, sampled);
      EXPECT_EQ(sampled.front(), expected);
    }
    parameters.time_gate = CodeGate{end, end};
    EXPECT_EQ(run(parameters, stream, 20), run(parameters, stream_of({}), 20));
  }
}

TEST(RawHistogram, OnlyOfReadoutsThatHoldAWholeOne) {
  for (const Readout readout : {Readout::kHisPointer1, Readout::kHisPointer, Readout::kSifh, Readout::kFifh,
                                Readout::kThreeSteps, Readout::kHistogram}) {
    EXPECT_GT(ReadoutParameters::defaults(readout).raw_bins(), 0) << readout_name(readout);
  }
  for (const Readout readout :
       {Readout::kEzPointer, Readout::kPifh, Readout::kPoolPointer, Readout::kPoolPointerLean}) {
    EXPECT_EQ(ReadoutParameters::defaults(readout).raw_bins(), 0) << readout_name(readout);
  }
  for (const Readout readout : kAllReadouts) {
    const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
    if (parameters.raw_bins() == 0) {
      EXPECT_THROW((void)make_readout_model(parameters)->run_raw_column(stream_of({1, 2}), 2), InputError)
          << readout_name(readout);
    }
  }
}

TEST(MalformedStream, RefusedWithRowAndReason) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHistogram, 4);
  EXPECT_THAT(
      [&] {
        run(parameters, {3, 16, 4});
      },
      ThrowsMessage<InputError>(HasSubstr("row 0: a timestamp is above 15")));
  EXPECT_THAT(
      [&] {
        run(parameters, stream_of({3, 4, 5}), 2);
      },
      ThrowsMessage<InputError>(HasSubstr("row 0: acquisition 2 is outside the frame of 2")));
  ReadoutParameters gated = parameters;
  gated.time_gate = CodeGate{3, 4};
  EXPECT_THAT(
      [&] {
        run(gated, {3, 16, 4});
      },
      ThrowsMessage<InputError>(HasSubstr("row 0: a timestamp is above 15")));
}

}  // namespace
}  // namespace dtof
