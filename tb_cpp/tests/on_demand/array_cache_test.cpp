// SPDX-License-Identifier: Apache-2.0
#include "on_demand/array_cache.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "dtof/core/error.hpp"
#include "on_demand/sha256.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

class Cache : public testing::Test {
 protected:
  Cache()
      : folder_(std::filesystem::temp_directory_path() / fmt::format("dtof_cache_test_{}", getpid())),
        cache_(folder_) {}
  ~Cache() override { std::filesystem::remove_all(folder_); }
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;
  Cache(Cache&&) = delete;
  Cache& operator=(Cache&&) = delete;

  std::string get(const std::string& key) {
    const std::filesystem::path file = cache_.get(
        key,
        [&](const std::filesystem::path& folder) {
          ++made_;
          std::ofstream(folder / ArrayCache::kFile) << "made of " << key;
        },
        [&](const std::string& line) { said_ += line + "\n"; });
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& key, const char* file, const std::string& text) {
    std::ofstream(cache_.entry(key) / file) << text;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& file : std::filesystem::directory_iterator(folder_)) {
      found.push_back(file.path().filename().string());
    }
    return found;
  }

  std::filesystem::path folder_;
  ArrayCache cache_;
  int made_ = 0;
  std::string said_;
};

TEST_F(Cache, MakesAnEntryOnce) {
  EXPECT_EQ(get("one"), "made of one");
  EXPECT_EQ(get("one"), "made of one");
  EXPECT_EQ(made_, 1);
  EXPECT_EQ(get("two"), "made of two");
  EXPECT_EQ(made_, 2);
  EXPECT_EQ(said_, "");
}

TEST_F(Cache, MakesADamagedEntryAgain) {
  const auto damages = std::vector<std::function<void()>>{
      [&] { write("key", ArrayCache::kFile, "made of kex"); },  // as long as before
      [&] { write("key", ArrayCache::kFile, ""); },
      [&] { write("key", "manifest", "nothing"); },
      [&] { std::filesystem::remove(cache_.entry("key") / "manifest"); },
      [&] { std::filesystem::remove(cache_.entry("key") / ArrayCache::kFile); },
  };
  (void)get("key");
  for (std::size_t i = 0; i < damages.size(); ++i) {
    SCOPED_TRACE(i);
    damages[i]();
    said_.clear();
    EXPECT_EQ(get("key"), "made of key");
    EXPECT_EQ(made_, static_cast<int>(i) + 2);
    EXPECT_THAT(said_, HasSubstr("is damaged and is built again"));
  }
}

TEST_F(Cache, LeavesNothingOfAnEntryThatCouldNotBeMade) {
  const auto fails = [](const std::filesystem::path& folder) {
    std::ofstream(folder / ArrayCache::kFile) << "half";
    throw Interrupted();
  };
  EXPECT_THROW((void)cache_.get("key", fails, [](const std::string&) {}), Interrupted);
  EXPECT_THAT(names(), testing::ElementsAre(testing::EndsWith(".lock")));
  EXPECT_EQ(get("key"), "made of key");
}

TEST_F(Cache, TakesUpWhereAProgramWasKilled) {
  const std::filesystem::path left = cache_.entry("key").string() + ".building";
  std::filesystem::create_directories(left / "work");
  EXPECT_EQ(get("key"), "made of key");
  EXPECT_FALSE(std::filesystem::exists(left));
}

TEST_F(Cache, OneOfManyMakesAnEntry) {
  std::atomic<int> made = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 6; ++i) {
    threads.emplace_back([&] {
      const auto file = cache_.get(
          "key",
          [&](const std::filesystem::path& folder) {
            ++made;
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
            std::ofstream(folder / ArrayCache::kFile) << "whole";
          },
          [](const std::string&) {});
      EXPECT_EQ(std::filesystem::file_size(file), 5U);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(made, 1);
}

TEST_F(Cache, SaysWhereItCannotWrite) {
  EXPECT_THAT([] { (void)ArrayCache("/proc/dtof").get("key", {}, {}); },
              ThrowsMessage<InputError>(HasSubstr("/proc/dtof: cannot make the folder")));
}

TEST_F(Cache, IsWhereTheUserSays) {
  setenv("XDG_CACHE_HOME", "/x", 1);
  setenv("HOME", "/h", 1);
  unsetenv("DTOF_CACHE");
  EXPECT_EQ(ArrayCache::of_user()->folder(), "/x/dtof");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(ArrayCache::of_user()->folder(), "/h/.cache/dtof");
  setenv("DTOF_CACHE", "/c", 1);
  EXPECT_EQ(ArrayCache::of_user()->folder(), "/c");
  setenv("DTOF_CACHE", "off", 1);
  EXPECT_FALSE(ArrayCache::of_user().has_value());
  unsetenv("DTOF_CACHE");
  unsetenv("HOME");
  EXPECT_THROW((void)ArrayCache::of_user(), InputError);
}

}  // namespace
}  // namespace dtof
