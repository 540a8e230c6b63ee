// SPDX-License-Identifier: Apache-2.0
// The fuzzers' first inputs, findings among them, in the ordinary build: each is read or refused, and at
// once.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "dtof/container/npz.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/npy.hpp"
#include "dtof/io/result_csv.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/picoquant.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/recording/tmf8820_json.hpp"
#include "dtof/recording/tmf8829_json.hpp"
#include "dtof/recording/transient_file.hpp"

namespace dtof {
namespace {

struct Reader {
  const char* name;
  std::function<void(const std::filesystem::path&)> read;
};

void PrintTo(const Reader& reader, std::ostream* stream) { *stream << reader.name; }

class FuzzCorpus : public testing::TestWithParam<Reader> {};

TEST_P(FuzzCorpus, IsReadOrRefusedAtOnce) {
  int files = 0;
  int read = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(DTOF_FUZZ_CORPUS) / GetParam().name)) {
    SCOPED_TRACE(entry.path().string());
    const auto start = std::chrono::steady_clock::now();
    ++files;
    try {
      GetParam().read(entry.path());
      ++read;
    } catch (const InputError& error) {
      EXPECT_STRNE(error.what(), "");
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }
  EXPECT_GT(read, 0);
  EXPECT_GT(files, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Readers, FuzzCorpus,
    testing::Values(Reader{"npz",
                           [](const auto& file) {
                             const std::string contents = read_file(file);
                             (void)parse_npz(file, contents, npz_names(file, contents).front());
                           }},
                    Reader{"picoquant",
                           [](const auto& file) {
                             std::string description;
                             (void)picoquant_cube(file, description);
                           }},
                    Reader{"result_csv", [](const auto& file) { (void)read_result_csv(file); }},
                    Reader{"histogram_npy", [](const auto& file) { (void)read_npy(file); }},
                    Reader{"transient_cube", [](const auto& file) { (void)read_transient_file(file); }},
                    Reader{"photon_times_mat", [](const auto& file) { (void)read_photon_times_mat(file); }},
                    Reader{"tmf8820_json", [](const auto& file) { (void)read_tmf8820_json(file); }},
                    Reader{"tmf8829_json", [](const auto& file) { (void)read_tmf8829_json(file); }},
                    Reader{"sensor_log",
                           [](const auto& file) {
                             const RecordingOptions options{.file = file.string(), .bin_width_s = 1e-9};
                             (void)open_recorded_data(options, read_recording(options));
                           }},
                    Reader{"depth_image", [](const auto& file) { (void)read_depth_image(file, 0.001); }}),
    [](const testing::TestParamInfo<Reader>& reader) { return reader.param.name; });

}  // namespace
}  // namespace dtof
