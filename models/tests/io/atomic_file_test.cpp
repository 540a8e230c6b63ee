// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/atomic_file.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "dtof/io/input_file.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class AtomicFileTest : public test::IoTest {};

TEST_F(AtomicFileTest, WritesTheWholeFileWithOrdinaryPermissions) {
  const std::string large(3'000'000, 'x');
  write_file(path("a"), large);
  EXPECT_EQ(contents(path("a")), large);
  EXPECT_EQ(file_count(), 1U);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  struct stat status {};
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0666U & ~mask);
}

TEST_F(AtomicFileTest, GzipHoldsTheContentsAndIsAlwaysTheSame) {
  std::string table = "a,b\n";
  for (int line = 0; line < 20'000; ++line) {
    table += std::to_string(line % 97) + ",0\n";
  }
  write_gzip_file(path("a.gz"), table);
  write_gzip_file(path("b.gz"), table);
  EXPECT_EQ(read_file_or_gzip(path("a.gz")), table);
  EXPECT_EQ(contents(path("a.gz")), contents(path("b.gz")));
  EXPECT_LT(contents(path("a.gz")).size(), table.size() / 10);
}

TEST_F(AtomicFileTest, ReplacesAnOlderFileOnlyAtCommit) {
  const auto file = write("a", "old");
  {
    AtomicFile output(file);
    output.append("new");
    EXPECT_EQ(contents(file), "old");
    output.commit();
  }
  EXPECT_EQ(contents(file), "new");
}

TEST_F(AtomicFileTest, LeavesNothingBehindAfterAnException) {
  const auto file = write("a", "old");
  EXPECT_THROW(
      {
        AtomicFile output(file);
        output.append(std::string(5'000'000, 'x'));
        throw std::runtime_error("stop");
      },
      std::runtime_error);
  EXPECT_EQ(contents(file), "old");
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(AtomicFileTest, KeepsASymbolicLink) {
  const auto file = write("a", "old");
  std::filesystem::create_symlink(file, path("link"));
  write_file(path("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(contents(file), "new");
}

TEST_F(AtomicFileTest, WritesTheFileThatALinkNamesAndThatIsNotThereYet) {
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink("folder/second", path("first"));
  std::filesystem::create_symlink("file", path("folder/second"));
  write_file(path("first"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("first")));
  EXPECT_TRUE(std::filesystem::is_symlink(path("folder/second")));
  EXPECT_EQ(contents(path("folder/file")), "new");
  std::filesystem::create_symlink(path("none/file"), path("dead"));
  test::expect_input_error([&] { write_file(path("dead"), "new"); },
                           path("dead").string() + ": cannot write: No such file or directory");
  std::filesystem::create_symlink("self", path("self"));
  test::expect_input_error([&] { write_file(path("self"), "new"); },
                           path("self").string() + ": cannot write: Too many levels of symbolic links");
  EXPECT_TRUE(std::filesystem::is_symlink(path("self")));
}

TEST_F(AtomicFileTest, WritesToADeviceDirectly) {
  write_file("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, RefusesWithPathAndReason) {
  const auto missing = path("missing/a");
  test::expect_input_error([&] { write_file(missing, "x"); },
                           missing.string() + ": cannot write: No such file or directory");
  const auto below_file = write("file", "x") / "a";
  test::expect_input_error([&] { write_file(below_file, "x"); },
                           AllOf(StartsWith(below_file.string()), EndsWith("Not a directory")));
  const auto directory = path("directory");
  std::filesystem::create_directory(directory);
  test::expect_input_error([&] { write_file(directory, "x"); }, EndsWith("it is a directory"));
  test::expect_input_error([] { write_file("", "x"); }, HasSubstr("cannot write"));
  test::expect_input_error([] { write_file("/dev/full", "x"); },
                           "/dev/full: cannot write: No space left on device");
  EXPECT_EQ(file_count(), 2U);
}

TEST_F(AtomicFileTest, RemovesTheTemporaryFileWhenTheDiskRefuses) {
  std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const struct rlimit small = {.rlim_cur = 100'000, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  test::expect_input_error([&] { write_file(path("a"), std::string(2'000'000, 'x')); },
                           path("a").string() + ": cannot write: File too large");
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(AtomicFileTest, RefusesAProtectedFile) {
  if (::geteuid() == 0) {
    GTEST_SKIP() << "root may write everything";
  }
  const auto file = write("a", "old");
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  test::expect_input_error([&] { write_file(file, "x"); }, EndsWith("Permission denied"));
  EXPECT_EQ(contents(file), "old");
}

TEST_F(AtomicFileTest, InputFileRefusals) {
  test::expect_input_error([&] { (void)read_file(path("none")); },
                           path("none").string() + ": cannot read: No such file or directory");
  test::expect_input_error([&] { (void)read_file(path("")); }, EndsWith("it is a directory"));
  test::expect_input_error([&] { (void)read_file(write("empty", "")); }, EndsWith("the file is empty"));
}

TEST_F(AtomicFileTest, GzipIsUnpackedFromAPipe) {
  const std::string text(300000, 'x');
  write_gzip_file(path("a.gz"), text);
  const std::string packed = contents(path("a.gz"));
  EXPECT_EQ(read_file_or_gzip(pipe_of(packed)), text);
  EXPECT_EQ(read_file_or_gzip(pipe_of("plain")), "plain");
  // Members follow each other, as `cat a.gz b.gz` writes them; what is no member is refused.
  EXPECT_EQ(unpack_gzip("a.gz", packed + packed), text + text);
  for (const std::string& rest : {std::string("rest"), std::string(1, '\0'), std::string("\x1f!")}) {
    test::expect_input_error([&] { (void)unpack_gzip("a.gz", packed + rest); },
                             "a.gz: damaged gzip data: other bytes follow");
    test::expect_input_error([&] { (void)read_file_or_gzip(pipe_of(packed + packed + rest)); },
                             EndsWith("damaged gzip data: other bytes follow"));
  }
  test::expect_input_error([&] { (void)unpack_gzip("a.gz", packed, 1U << 18U); },
                           "a.gz: more than 0 MiB to read");
  for (std::size_t size = 2; size < packed.size(); size += 7) {
    test::expect_input_error([&] { (void)unpack_gzip("a.gz", packed.substr(0, size)); },
                             "a.gz: damaged gzip data: the file ends early");
  }
  test::expect_input_error([&] { (void)unpack_gzip("a.gz", packed + packed.substr(0, 12)); },
                           "a.gz: damaged gzip data: the file ends early");
}

TEST(ByteOrderMark, StandsInFrontOnly) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF{}"), "{}");
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB{}"), "\xEF\xBB{}");
  EXPECT_EQ(without_byte_order_mark("{}\xEF\xBB\xBF"), "{}\xEF\xBB\xBF");
}

}  // namespace
}  // namespace dtof
