// SPDX-License-Identifier: Apache-2.0
// Histograms that stay in their file become the photons of those that are held.
#include "dtof/recording/histogram_file.hpp"

#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "dtof/container/npz.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/recording/recording.hpp"
#include "tests/container/hdf5_writer.hpp"
#include "tests/container/zip_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

class HistogramFileTest : public test::IoTest {
 protected:
  HistogramFileTest() : counts_(5 * 4 * 16) {
    std::mt19937_64 random(test::test_seed());
    for (double& count : counts_) {
      count = static_cast<double>(random() % 4);
    }
  }
  [[nodiscard]] static RecordingOptions options_of(const std::filesystem::path& file,
                                                   const std::optional<double>& budget) {
    RecordingOptions options{.file = file.string(), .bin_width_s = 1e-9};
    options.resampling.photon_budget = budget;
    options.resampling.background = 0.01;
    return options;
  }
  [[nodiscard]] static bool stays_in_its_file(const RecordingOptions& options) {
    return std::holds_alternative<HistogramFile>(open_recorded_data(options, read_recording(options)).data);
  }
  /// The refusal of the counts in a file is that of the held ones.
  void refused_alike(const std::vector<double>& counts, const std::optional<double>& budget) const {
    const std::vector<std::size_t> shape = {2, 2, 2};
    write_npy(path("w.npy"), shape, counts);
    const RecordingOptions options = options_of(path("w.npy"), budget);
    std::string sentence = "none";
    try {
      const HistogramStream stream(histogram_cube({shape, counts}, 1e-9, 0.0, options.file),
                                   options.resampling);
    } catch (const InputError& error) {
      sentence = error.what();
    }
    test::expect_input_error([&] { (void)open_recording(options, read_recording(options)); }, sentence);
  }

  std::vector<double> counts_;
};

TEST_F(HistogramFileTest, PhotonsAreThoseOfAHeldCube) {
  const std::vector<std::size_t> shape = {5, 4, 16};
  write_npy(path("a.npy"), shape, counts_);
  write_gzip_file(path("a.npy.gz"), contents(path("a.npy")));
  test::write_zip(path("stored.npz"), {test::stored_part("a.npy", contents(path("a.npy")))}, false);
  test::write_zip(path("deflated.npz"), {test::deflated_part("a.npy", contents(path("a.npy")))}, false);
  test::write_hdf5(path("a.h5"), {5, 4, 16}, counts_);
  test::write_hdf5(path("chunks.h5"), {5, 4, 16}, counts_, H5T_STD_U16BE,
                   {.chunk = {2, 3, 5}, .deflate = true});
  test::write_hdf5(path("matlab.h5"), {5, 4, 16}, counts_, H5T_IEEE_F32LE, {.matlab = true});
  for (const std::optional<double> budget : {std::optional<double>(), std::optional(20.0)}) {
    const HistogramStream held(histogram_cube({shape, counts_}, 1e-9),
                               options_of(path("a.npy"), budget).resampling);
    for (const auto& [name, stays] : {std::pair{"a.npy", true},
                                      {"stored.npz", true},
                                      {"a.npy.gz", false},
                                      {"deflated.npz", false},
                                      {"a.h5", true},
                                      {"chunks.h5", true},
                                      {"matlab.h5", false}}) {
      SCOPED_TRACE(name);
      const RecordingOptions options = options_of(path(name), budget);
      EXPECT_EQ(stays_in_its_file(options), stays);
      const Recording recording = open_recording(options, read_recording(options));
      ASSERT_EQ(recording.source->columns(), 4);
      ASSERT_EQ(recording.source->rows(), 5);
      for (int column = 0; column < 4; ++column) {
        EXPECT_EQ(recording.source->column(column), held.column(column));
        EXPECT_EQ(recording.source->column_rows(column, {2, 2}), held.column_rows(column, {2, 2}));
      }
    }
  }
}

TEST_F(HistogramFileTest, RefusalsAreThoseOfAHeldCube) {
  for (const std::optional<double> budget : {std::optional<double>(), std::optional(20.0)}) {
    refused_alike({0, 1, 2, -1, 0, 0, 0, 0}, budget);
    refused_alike({0, 1, 2, 3, 0, 0, 0, 0x1.0p54}, budget);
  }
  refused_alike({0.5, 1, 2, 3, 0, 0, 0, 1e9}, std::nullopt);  // too many photons are said first
  refused_alike({0, 1, 0, 0.5, 0, 0.25, 0, 0}, std::nullopt);
  write_npy(path("a.npy"), std::vector<std::size_t>{}, std::vector<double>{1.0});
  const RecordingOptions options = options_of(path("a.npy"), std::nullopt);
  test::expect_input_error([&] { (void)open_recording(options, read_recording(options)); },
                           options.file + ": the array is a single number, its last axis must be the bins");
}

TEST_F(HistogramFileTest, AFileThatShrinksIsRefused) {
  write_npy(path("a.npy"), std::vector<std::size_t>{5, 4, 16}, counts_);
  const RecordingOptions options = options_of(path("a.npy"), std::nullopt);
  const Recording recording = open_recording(options, read_recording(options));
  std::filesystem::resize_file(path("a.npy"), 1000);
  test::expect_input_error([&] { (void)recording.source->column(3); },
                           options.file + ": the file ends early");
}

}  // namespace
}  // namespace dtof
