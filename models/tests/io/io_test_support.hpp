// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof::test {

/// Gives each test a directory of its own, removed afterwards.
class IoTest : public ::testing::Test {
 public:
  IoTest(const IoTest&) = delete;
  IoTest& operator=(const IoTest&) = delete;
  IoTest(IoTest&&) = delete;
  IoTest& operator=(IoTest&&) = delete;

 protected:
  IoTest() {
    std::string name = (std::filesystem::temp_directory_path() / "dtof_io_XXXXXX").string();
    directory_ = ::mkdtemp(name.data());
  }
  ~IoTest() override {
    for (const int pipe : pipes_) {
      ::close(pipe);
    }
    std::error_code ignored;
    std::filesystem::permissions(directory_, std::filesystem::perms::owner_all, ignored);
    std::filesystem::remove_all(directory_, ignored);
  }

  [[nodiscard]] std::filesystem::path path(std::string_view name) const { return directory_ / name; }

  [[nodiscard]] std::filesystem::path write(std::string_view name, std::string_view contents) const {
    std::ofstream(path(name), std::ios::binary) << contents;
    return path(name);
  }

  /// A pipe that delivers these bytes once; they must fit into a pipe.
  [[nodiscard]] std::filesystem::path pipe_of(std::string_view bytes) {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    EXPECT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    ::close(ends[1]);
    pipes_.push_back(ends[0]);
    return "/dev/fd/" + std::to_string(ends[0]);
  }

  [[nodiscard]] static std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(directory_), {}));
  }

 private:
  std::filesystem::path directory_;
  std::vector<int> pipes_;
};

/// `action` must throw an InputError whose one-line message matches.
template <typename Action, typename Matcher>
void expect_input_error(const Action& action, const Matcher& matcher) {
  try {
    action();
    ADD_FAILURE() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(std::string(error.what()), matcher);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

/// File of recorded data that is not part of the project.
inline std::filesystem::path shared_data(std::string_view name) {
  return std::filesystem::path(DTOF_SHARED_DATA_DIR) / name;
}

inline std::uint64_t test_seed() {
  const char* const text = std::getenv("DTOF_TEST_SEED");
  return text == nullptr ? 20240229 : std::strtoull(text, nullptr, 10);
}

}  // namespace dtof::test

#define DTOF_SKIP_IF_ABSENT(file)                                 \
  do {                                                            \
    if (!std::filesystem::exists(file)) {                         \
      GTEST_SKIP() << (file) << " is absent: recorded data test"; \
    }                                                             \
  } while (false)
