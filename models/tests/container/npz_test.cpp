// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/npz.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;

class NpzTest : public test::IoTest {
 protected:
  [[nodiscard]] std::string two_arrays(const std::string& name) const {
    NpzWriter writer(path(name));
    writer.add("depth_m", std::vector<std::size_t>{1, 3}, std::vector<float>{1.5F, 0.0F, 2.5F});
    writer.add("counts", std::vector<std::size_t>{2}, std::vector<double>{3.0, 1e9});
    writer.commit();
    return contents(path(name));
  }
};

TEST_F(NpzTest, ReadsWhatItWrites) {
  const std::string file = two_arrays("a.npz");
  EXPECT_TRUE(is_zip(file));
  EXPECT_THAT(npz_names("a.npz", file), ElementsAre("depth_m", "counts"));
  const NpyArray depth = parse_npz("a.npz", file, "depth_m");
  EXPECT_THAT(depth.shape, ElementsAre(1, 3));
  EXPECT_THAT(depth.values, ElementsAre(1.5, 0.0, 2.5));
  EXPECT_THAT(parse_npz("a.npz", file, "counts").values, ElementsAre(3.0, 1e9));
  EXPECT_EQ(file, two_arrays("b.npz")) << "equal arrays give equal files";
}

TEST_F(NpzTest, NumPyReadsItAndIsRead) {
  (void)two_arrays("a.npz");
  const std::string script =
      "import numpy as np; a = np.load('" + path("a.npz").string() +
      "'); assert a['depth_m'].dtype == np.float32 and a['depth_m'].tolist() == [[1.5, 0.0, 2.5]]; "
      "assert a['counts'].tolist() == [3.0, 1e9]; "
      "np.savez('" +
      path("plain.npz").string() + "', cube=np.arange(24, dtype='u2').reshape(2, 3, 4)); " +
      "np.savez_compressed('" + path("packed.npz").string() + "', cube=np.arange(24.0).reshape(2, 3, 4))";
  ASSERT_EQ(std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str()), 0);
  for (const char* const name : {"plain.npz", "packed.npz"}) {
    const NpyArray cube = parse_npz(name, contents(path(name)), "");
    EXPECT_THAT(cube.shape, ElementsAre(2, 3, 4));
    EXPECT_EQ(cube.values[23], 23.0);
  }
}

TEST_F(NpzTest, EachRefusalHasItsSentence) {
  const std::string file = two_arrays("a.npz");
  const auto refused = [](std::string_view contents, const std::string& name, const std::string& sentence) {
    test::expect_input_error([&] { (void)parse_npz("a.npz", contents, name); }, "a.npz: " + sentence);
  };
  refused(file, "", "the archive has 2 arrays (depth_m, counts); name one, as a.npz:depth_m");
  refused(file, "depth", "the archive has no array 'depth', but depth_m, counts");
  refused(file.substr(0, 60), "depth_m", "the NPZ archive is damaged or encrypted");
  refused("PK\x03\x04 and no more", "", "the NPZ archive is damaged or encrypted");
  std::string flipped = file;
  flipped[100] = static_cast<char>(flipped[100] ^ 0x55);  // in the packed data of depth_m
  test::expect_input_error([&] { (void)parse_npz("a.npz", flipped, "depth_m"); },
                           "a.npz:depth_m: damaged: invalid distance code");
  {
    NpzWriter none(path("none.npz"));
    none.commit();
  }
  refused(contents(path("none.npz")), "", "the NPZ archive has no array");
}

TEST_F(NpzTest, WithoutCommitThereIsNoFile) {
  {
    NpzWriter writer(path("a.npz"));
    writer.add("a", std::vector<std::size_t>{1}, std::vector<double>{1.0});
    EXPECT_THROW(writer.add("b", std::vector<std::size_t>{2}, std::vector<double>{1.0}), std::logic_error);
  }
  EXPECT_EQ(file_count(), 0U);
  test::expect_input_error(
      [&] {
        NpzWriter writer("/dev/full");
        const std::vector<double> values(1U << 20U, 1.0);
        writer.add("a", std::vector<std::size_t>{values.size()}, values);
        writer.commit();
      },
      "/dev/full: cannot write: No space left on device");
}

}  // namespace
}  // namespace dtof
