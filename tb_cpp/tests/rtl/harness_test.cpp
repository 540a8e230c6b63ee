// SPDX-License-Identifier: Apache-2.0
// The harness itself: what it refuses, what it reports, and that a fault in the RTL becomes an exception.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <verilated.h>

#include <filesystem>

#include "dtof/core/error.hpp"
#include "dtof/readout/run_frame.hpp"
#include "rtl/error.hpp"
#include "rtl/run_frame.hpp"
#include "tests/rtl/rtl_test_support.hpp"

namespace dtof {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

RtlConfiguration small_sifh() {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 4);
  parameters.count_width = 4;
  return find_rtl_configuration(parameters, 1, 1);
}

// Random columns, each from its index alone.
class RandomSource : public StreamSource {
 public:
  RandomSource(ReadoutParameters parameters, int columns, int rows, std::uint32_t acquisitions)
      : parameters_(parameters), columns_(columns), rows_(rows), acquisitions_(acquisitions) {}
  [[nodiscard]] int columns() const override { return columns_; }
  [[nodiscard]] int rows() const override { return rows_; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return acquisitions_; }
  [[nodiscard]] ColumnStream column(int index) const override {
    CounterRandom random = test_random(test_seed(), 100 + static_cast<std::uint32_t>(index));
    ColumnStream stream;
    for (int row = 0; row < rows_; ++row) {
      stream.append_row(make_stream(StreamKind::kUniform, parameters_, acquisitions_, random));
    }
    return stream;
  }

 private:
  ReadoutParameters parameters_;
  int columns_;
  int rows_;
  std::uint32_t acquisitions_;
};

TEST(Registry, ListsWhatIsCompiled) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh, 13);
  EXPECT_THAT([&] { find_rtl_configuration(parameters, 160, 8); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("sifh NP=13"), HasSubstr("compiled are"),
                                              HasSubstr("sifh NP=10 SLOTS=2 NB=6 COUNT_WIDTH=10"))));
  RtlConfiguration configuration = small_sifh();
  configuration.sram_num = 77;
  EXPECT_THAT([&] { RtlReadout rtl(configuration); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("SRAM_NUM=77"), HasSubstr("compiled are"))));
}

TEST(Registry, IgnoresParametersTheReadoutDoesNotUse) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kEzPointer);
  parameters.nb = 3;
  parameters.guard = 1;
  parameters.window_centred = true;
  EXPECT_EQ(find_rtl_configuration(parameters, 160, 8).parameters.np, 10);
}

TEST(Registry, PrefersTheThesisVariantAndTheSizeThatSimulatesLeast) {
  for (const Readout readout : array_readouts()) {
    const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
    for (const int columns : {1, 200}) {
      const RtlConfiguration configuration = find_rtl_configuration(parameters, 160, columns);
      EXPECT_EQ(configuration.pointer_ports, 2);
      EXPECT_FALSE(configuration.signalled_clear);
      EXPECT_EQ(configuration.sram_num == 1, columns == 1) << readout_name(readout);
    }
  }
}

TEST(Registry, FindsTheArrayThatRecordsAWaveform) {
  for (const Readout readout : array_readouts()) {
    SCOPED_TRACE(readout_name(readout));
    const ReadoutParameters parameters = ReadoutParameters::defaults(readout);
    EXPECT_FALSE(find_rtl_configuration(parameters, 160, 200).records_waveform);
    EXPECT_TRUE(find_rtl_configuration(parameters, 160, 200, true).records_waveform);
  }
}

TEST(RtlReadout, RefusesATraceOfAnArrayThatRecordsNone) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kEzPointer);
  RtlReadout rtl(find_rtl_configuration(parameters, 160, 200));
  RtlRunOptions options;
  options.trace = "trace.fst";
  EXPECT_THAT([&] { rtl.run({}, 1, options); },
              ThrowsMessage<InputError>(HasSubstr("built without waveforms")));
}

TEST(RtlConfiguration, ResultsComeRowByRowOrEngineByEngine) {
  const auto order = [](Readout readout) {
    RtlConfiguration configuration{.parameters = ReadoutParameters::defaults(readout)};
    configuration.pixels_per_sram = 2;
    configuration.sram_num = 5;
    configuration.parameters.pool.engine_columns = 2;
    std::string text;
    for (const ResultAddress& pixel : configuration.result_order()) {
      text += fmt::format("{}{}{} ", pixel.begins_row ? "|" : "", pixel.row, pixel.column);
    }
    return text;
  };
  EXPECT_EQ(order(Readout::kSifh), "|00 01 02 03 04 |10 11 12 13 14 ");
  EXPECT_EQ(order(Readout::kPoolPointer), "|00 02 04 |10 12 14 |01 03 |11 13 ");
}

TEST(RtlReadout, RefusesStreamsThatDoNotFit) {
  RtlReadout rtl(small_sifh());
  const auto run = [&](const std::vector<ColumnStream>& columns, std::uint32_t acquisitions) {
    return [&rtl, columns, acquisitions] { rtl.run(columns, acquisitions); };
  };
  const ColumnStream fits = single_pixel({1, 2}, 2);
  ColumnStream two_rows = fits;
  two_rows.finish_row();
  ColumnStream backwards;
  backwards.append({1, 3});
  backwards.append({0, 3});
  backwards.finish_row();
  EXPECT_THAT(run({fits, fits}, 1),
              ThrowsMessage<InputError>(HasSubstr("2 columns for an array of SRAM_NUM = 1")));
  EXPECT_THAT(run({two_rows}, 1), ThrowsMessage<InputError>(HasSubstr("PIXELS_PER_SRAM = 1")));
  EXPECT_THAT(run({fits}, 70'000), ThrowsMessage<InputError>(HasSubstr("70000 acquisitions")));
  EXPECT_THAT(run({single_pixel({1, 16}, 2)}, 1),
              ThrowsMessage<InputError>(HasSubstr("column 0 row 0: timestamp 16 does not fit NP = 4")));
  EXPECT_THAT(run({single_pixel({1, 2, 3}, 3)}, 1),
              ThrowsMessage<InputError>(HasSubstr("more than SLOTS = 2")));
  EXPECT_THAT(run({single_pixel({1, 2, 3}, 2)}, 1),
              ThrowsMessage<InputError>(HasSubstr("acquisition 1 in a frame of 1")));
  EXPECT_THAT(run({backwards}, 2), ThrowsMessage<InputError>(HasSubstr("acquisition 0 after 1")));
  EXPECT_EQ(rtl.run(std::span(&fits, 1), 1).results.size(), 1U) << "a refusal leaves the array usable";
}

TEST(RtlReadout, GivesUpAFrameThatDoesNotEnd) {
  RtlReadout rtl(small_sifh());
  RtlRunOptions options = default_options(1);
  options.cycle_limit = 25;
  const std::vector<ColumnStream> columns = {single_pixel(std::vector<Timestamp>(200, 3), 2)};
  EXPECT_THAT([&] { rtl.run(columns, 100, options); },
              ThrowsMessage<RtlError>(AllOf(HasSubstr("did not end within 25 clocks"), HasSubstr("state M0"),
                                            HasSubstr("of 100 acquisitions begun"),
                                            HasSubstr("0 of 1 results sent"))));
  options.cycle_limit = 0;
  EXPECT_TRUE(agrees_with_model(rtl, columns, 100, options)) << "usable afterwards";
}

TEST(RtlReadout, CountsTheClocksOfEachState) {
  RtlReadout rtl(small_sifh());
  const std::vector<ColumnStream> columns = {single_pixel({1, 2, 3, 4}, 2)};
  const RtlStatistics statistics = rtl.run(columns, 2).statistics;
  std::uint64_t sum = 0;
  for (const std::uint64_t clocks : statistics.state_cycles) {
    sum += clocks;
  }
  EXPECT_EQ(sum, statistics.cycles + 1) << "start and done clocks included";
  // Between measurement 1 and 2 every bin is visited once.
  EXPECT_GE(statistics.state_cycles[static_cast<std::size_t>(RtlState::kM1)], 8U);
  EXPECT_GT(statistics.column_cycles, statistics.cycles);
}

TEST(RtlReadout, WritesATraceOfEachRun) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "rtl_readout_test.fst";
  RtlReadout rtl(small_sifh());
  RtlRunOptions options;
  options.trace = file;
  const std::vector<ColumnStream> columns = {single_pixel({1, 2, 3, 4}, 2)};
  for (int i = 0; i < 2; ++i) {
    std::filesystem::remove(file);
    rtl.run(columns, 2, options);
    ASSERT_TRUE(std::filesystem::exists(file));
    EXPECT_GT(std::filesystem::file_size(file), 500U);
  }
  std::filesystem::remove(file);
  options.trace = "/nonexistent/trace.fst";
  EXPECT_THAT([&] { rtl.run(columns, 2, options); },
              ThrowsMessage<InputError>(HasSubstr("cannot write trace file '/nonexistent/trace.fst'")));
}

TEST(RtlReadout, ReportsTheSramsOnRequest) {
  testing::internal::CaptureStdout();
  RtlReadout rtl(small_sifh(), true);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("two-port SRAM, 8 words x 4 bits"));
}

// $error of a failed assertion prints, then stops; $fatal and $finish stop.
TEST(VerilatedHooks, AFailedAssertionIsAnException) {
  VerilatedContext context;
  Verilated::threadContextp(&context);
  EXPECT_THAT(
      [] {
        VL_PRINTF_MT(
            "[%s] %%Error: dtof_pixel_sequencer.sv:107: Assertion failed: a gap inside an acquisition\n",
            "40");
        VL_STOP_MT("dtof_pixel_sequencer.sv", 107, "array");
      },
      ThrowsMessage<RtlError>(HasSubstr("a gap inside an acquisition")));
  EXPECT_THAT([] { VL_STOP_MT("a.sv", 7, "array"); }, ThrowsMessage<RtlError>(HasSubstr("a.sv:7")));
  EXPECT_THAT([] { VL_FINISH_MT("a.sv", 8, "array"); }, ThrowsMessage<RtlError>(HasSubstr("$finish")));
  EXPECT_THAT([] { VL_FATAL_MT("a.sv", 9, "array", "did not converge"); },
              ThrowsMessage<RtlError>(HasSubstr("did not converge")));
}

// A gap inside an acquisition breaks the protocol; the RTL's own assertion must stop the run.
TEST(VerilatedHooks, AssertionsOfTheRtlAreAlive) {
  VerilatedContext context;
  Verilated::threadContextp(&context);
  std::array<const char*, 1> arguments = {"test"};
  context.commandArgs(1, arguments.data());
  const std::unique_ptr<ArrayModel> model = make_array_model(small_sifh(), context);
  const ArrayModel::Ports ports = model->ports();
  const auto clock = [&] {
    *ports.clock = 0;
    model->eval();
    *ports.clock = 1;
    model->eval();
  };
  *ports.reset_n = 0;
  *ports.result_ready = 1;
  clock();
  *ports.reset_n = 1;
  *ports.start = 1;
  *ports.acquisitions = 2;
  *ports.tdc_valid = 1;
  const auto run_until_the_gap = [&] {
    for (int i = 0; i < 100; ++i) {
      *ports.clock = 0;
      model->eval();
      const bool begins = *ports.tdc_ready != 0;
      *ports.clock = 1;
      model->eval();
      if (begins) {
        *ports.tdc_valid = 0;
        clock();
        clock();
        return;
      }
    }
  };
  // When, where and what, as Verilator would print it.
  EXPECT_THAT(
      run_until_the_gap,
      ThrowsMessage<RtlError>(AllOf(
          HasSubstr("[0] %Error: dtof_pixel_sequencer.sv:"),
          HasSubstr("Assertion failed in array.dtof_array_testbench.u_array.u_control.u_pixel_sequencer."),
          HasSubstr("tdc_valid_i fell inside an acquisition"))));
}

TEST(TimeGate, IsRefusedWhereThereIsNoneOrOutOfRange) {
  RtlReadout without(small_sifh());
  EXPECT_THAT(
      [&] {
        without.set_time_gate({1, 2});
      },
      ThrowsMessage<InputError>(HasSubstr("has no time gate")));
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kSifh);
  parameters.time_gate = CodeGate{100, 200};
  RtlReadout with(find_rtl_configuration(parameters, 5, 1));
  EXPECT_EQ(with.configuration().parameters.time_gate, (CodeGate{100, 200}));
  EXPECT_THAT(
      [&] {
        with.set_time_gate({0, 1024});
      },
      ThrowsMessage<InputError>(HasSubstr("gate end must be 0 to 1023, not 1024")));
}

// An array with a fault in its result stream.
class FaultyArray : public ArrayModel {
 public:
  enum class Fault : std::uint8_t { kCode, kUnstable, kLast, kColumn, kDone };

  FaultyArray(VerilatedContext& context, Fault fault)
      : model_(make_array_model(small_sifh(), context)), fault_(fault) {}
  [[nodiscard]] Ports ports() override {
    right_ = model_->ports();
    Ports ports = right_;
    ports.result_code = &code_;
    ports.result_last = &last_;
    ports.result_column = &column_;
    ports.done = &done_;
    return ports;
  }
  void eval() override {
    model_->eval();
    ++evaluations_;
    code_ = *right_.result_code;
    last_ = *right_.result_last;
    column_ = *right_.result_column;
    done_ = *right_.done;
    switch (fault_) {
      case Fault::kCode:
        code_ ^= 1U;
        break;
      case Fault::kUnstable:
        code_ = static_cast<std::uint16_t>(evaluations_);
        break;
      case Fault::kLast:
        last_ = 0;
        break;
      case Fault::kColumn:
        ++column_;
        break;
      case Fault::kDone:
        done_ = *right_.state == static_cast<std::uint8_t>(RtlState::kM4) ? 1 : 0;
        break;
    }
  }
  void open_trace(const std::filesystem::path& file) override { model_->open_trace(file); }
  void dump_trace(std::uint64_t time) override { model_->dump_trace(time); }
  void close_trace() override { model_->close_trace(); }

 private:
  std::unique_ptr<ArrayModel> model_;
  Fault fault_;
  Ports right_{};
  std::uint64_t evaluations_ = 0;
  std::uint16_t code_ = 0;
  std::uint16_t column_ = 0;
  std::uint8_t last_ = 0;
  std::uint8_t done_ = 0;
};

class FaultyRtl : public testing::Test {
 protected:
  // Under a name that is not compiled at this size.
  static RtlReadout with(FaultyArray::Fault fault) {
    RtlConfiguration configuration = small_sifh();
    configuration.signalled_clear = true;
    register_rtl_configuration(configuration, [fault](VerilatedContext& context) {
      return std::make_unique<FaultyArray>(context, fault);
    });
    return RtlReadout(configuration);
  }
  static std::string error_of(FaultyArray::Fault fault) {
    RtlReadout rtl = with(fault);
    RtlRunOptions options = default_options(9);
    options.row_stall = 2;
    try {
      rtl.run(columns(), 4, options);
    } catch (const RtlError& error) {
      return error.what();
    }
    return "no error";
  }
  static std::vector<ColumnStream> columns() { return {single_pixel({11, 9, 11, 15, 10, 10, 15, 11}, 2)}; }
};

TEST_F(FaultyRtl, AWrongResultIsReportedWithTheShortestFrameAndTheCommand) {
  RtlReadout rtl = with(FaultyArray::Fault::kCode);
  EXPECT_THAT(check_frame(rtl, columns(), 4, default_options(9), "the command"),
              AllOf(HasSubstr("1 of 1 pixels differ"), HasSubstr("sifh NP=4"), HasSubstr("seed 9"),
                    HasSubstr("cut to 1 acquisitions"),
                    HasSubstr("column 0 row 0: expected code 10 fraction 0 confidence 2, actual code 11"),
                    HasSubstr("reproduce  the command")));
}

TEST_F(FaultyRtl, ABrokenResultStreamIsAnError) {
  using enum FaultyArray::Fault;
  EXPECT_THAT(error_of(kUnstable), HasSubstr("result_tdata_o changed before tready"));
  EXPECT_THAT(error_of(kLast), HasSubstr("result_tlast_o on the wrong result"));
  EXPECT_THAT(error_of(kColumn), HasSubstr("result out of order"));
  EXPECT_THAT(error_of(kDone), HasSubstr("busy after done"));
}

class RunFrame : public testing::Test {
 protected:
  ReadoutParameters parameters_ = ReadoutParameters::defaults(Readout::kHisPointer);
  RandomSource source_{parameters_, 21, 5, 40};
};

TEST_F(RunFrame, AgreesWithTheModelWhateverTheThreads) {
  SCOPED_TRACE(test_seed_message());
  const std::vector<PixelResult> expected = run_frame(source_, parameters_);
  for (const int threads : {1, 2, 0}) {
    const RtlSourceFrame frame = run_frame_rtl(source_, parameters_, threads);
    EXPECT_EQ(frame.results, expected) << threads << " threads";
    EXPECT_GT(frame.statistics.cycles, 40U * 160U * 2U);
    EXPECT_LT(frame.result_cycles.front(), frame.result_cycles.back());
  }
}

TEST_F(RunFrame, ReadsOnlyTheChosenColumns) {
  SCOPED_TRACE(test_seed_message());
  const std::vector<int> columns = {20, 3, 4};
  const RtlSourceFrame frame = run_frame_rtl(source_, parameters_, 0, columns);
  EXPECT_EQ(frame.results, run_frame(source_, parameters_, 0, columns));
  const std::uint64_t few = frame.statistics.column_cycles;
  const std::uint64_t all = run_frame_rtl(source_, parameters_).statistics.column_cycles;
  EXPECT_LT(few * 2, all) << "3 of 21 columns";
}

TEST_F(RunFrame, StacksShortColumns) {
  SCOPED_TRACE(test_seed_message());
  const RtlSourceFrame few = run_frame_rtl(source_, parameters_);
  for (const int columns : {83, 200}) {
    const RandomSource wide(parameters_, columns, 5, 40);
    const RtlSourceFrame frame = run_frame_rtl(wide, parameters_);
    EXPECT_EQ(frame.results, run_frame(wide, parameters_)) << columns;
    EXPECT_LE(frame.statistics.column_cycles, 2 * few.statistics.column_cycles)
        << "21 columns take three groups";
  }
}

TEST_F(RunFrame, RefusesColumnsOutsideTheSourceAndTracesOfManyGroups) {
  const std::vector<int> outside = {21};
  EXPECT_THAT([&] { run_frame_rtl(source_, parameters_, 0, outside); },
              ThrowsMessage<InputError>(HasSubstr("column 21 is outside the source's 0 to 20")));
  RtlRunOptions options;
  options.trace = "trace.fst";
  EXPECT_THAT([&] { run_frame_rtl(source_, parameters_, 0, {}, options); },
              ThrowsMessage<InputError>(HasSubstr("a waveform holds at most SRAM_NUM")));
}

}  // namespace
}  // namespace dtof
