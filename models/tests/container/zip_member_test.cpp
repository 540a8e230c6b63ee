// SPDX-License-Identifier: Apache-2.0
// Arrays in archives: read in pieces, at any place, and held they are the same; each wrong archive has its
// sentence.
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "dtof/container/npz.hpp"
#include "tests/container/zip_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using test::bytes_of;
using test::npy_begin;
using test::ZipPart;
using ::testing::ElementsAre;

class ZipMemberTest : public test::IoTest {
 protected:
  /// Three numbers of 64 bits.
  static std::string three() {
    return npy_begin("<f8", "(3,)") + bytes_of(1.5) + bytes_of(2.5) + bytes_of(3.5);
  }
  std::filesystem::path archive_of(const std::vector<ZipPart>& parts, bool zip64 = false) const {
    test::write_zip(path("a.npz"), parts, zip64);
    return path("a.npz");
  }
  void refused(const std::filesystem::path& archive, const std::string& sentence) const {
    test::expect_input_error([&] { (void)NpzArchive(archive).read("a"); }, archive.string() + sentence);
    const std::string bytes = contents(archive);
    test::expect_input_error([&] { (void)parse_npz(archive, bytes, "a"); }, archive.string() + sentence);
  }
};

TEST_F(ZipMemberTest, PiecesAndPlacesAreThoseOfTheHeldArrayForEveryDtype) {
  const std::string script =
      "import numpy as np; g = np.random.default_rng(1); d = {}\n"
      "for t in ['|i1', '<i2', '<i4', '<i8', '|u1', '<u2', '<u4', '<u8', '<f2', '<f4', '<f8', '>i2', '>i4',"
      " '>i8', '>u2', '>u4', '>u8', '>f2', '>f4', '>f8']:\n"
      "    c = g.integers(0, 100, (5, 7, 11)).astype(t)\n"
      "    d[t + 'C'] = c; d[t + 'F'] = np.asfortranarray(c)\n"
      "np.savez('" +
      path("stored.npz").string() + "', **d); np.savez_compressed('" + path("packed.npz").string() +
      "', **d)";
  ASSERT_EQ(std::system(("/usr/bin/python3 -c \"" + script + "\"").c_str()), 0);
  const NpzArchive stored(path("stored.npz"));
  const NpzArchive packed(path("packed.npz"));
  ASSERT_EQ(stored.names().size(), 40U);
  EXPECT_EQ(packed.names(), stored.names());
  const std::string bytes = contents(path("stored.npz"));
  for (const std::string& name : stored.names()) {
    SCOPED_TRACE(name);
    const NpyArray held = parse_npz("stored.npz", bytes, name);
    EXPECT_THAT(held.shape, ElementsAre(5, 7, 11));
    for (const NpzArchive* const archive : {&stored, &packed}) {
      const std::unique_ptr<ArrayReader> array = archive->open(name);
      EXPECT_EQ(array->shape(), held.shape);
      std::vector<double> values(held.values.size());
      std::span<double> left(values);
      for (std::size_t piece = 1; !left.empty(); ++piece) {
        const std::size_t now = std::min(piece, left.size());
        array->next(left.first(now));
        left = left.subspan(now);
      }
      EXPECT_EQ(values, held.values);
      ASSERT_EQ(array->any_place(), archive == &stored && name.back() == 'C');
      if (array->any_place()) {
        std::vector<double> some(11);
        array->read_at(22, some);
        EXPECT_EQ(some, std::vector<double>(held.values.begin() + 22, held.values.begin() + 33));
      }
    }
  }
}

TEST_F(ZipMemberTest, Zip64IsRead) {
  for (const bool zip64 : {false, true}) {
    const NpzArchive archive(
        archive_of({test::stored_part("a.npy", three()), test::deflated_part("b.npy", three())}, zip64));
    EXPECT_THAT(archive.names(), ElementsAre("a", "b"));
    EXPECT_THAT(archive.read("a").values, ElementsAre(1.5, 2.5, 3.5));
    EXPECT_THAT(archive.read("b").values, ElementsAre(1.5, 2.5, 3.5));
  }
  ASSERT_EQ(std::system(("/usr/bin/python3 -c \"import numpy; assert numpy.load('" + path("a.npz").string() +
                         "')['b'].tolist() == [1.5, 2.5, 3.5]\"")
                            .c_str()),
            0);
}

TEST_F(ZipMemberTest, ACommentBehindTheArchiveIsSkipped) {
  (void)archive_of({test::stored_part("a.npy", three())});
  std::string bytes = contents(path("a.npz"));
  bytes.replace(bytes.size() - 2, 2, bytes_of(std::uint16_t{30}));
  bytes += "PK\x05\x06" + std::string(26, '.');  // what looks like an end is none
  EXPECT_THAT(NpzArchive(write("b.npz", bytes)).read("a").values, ElementsAre(1.5, 2.5, 3.5));
}

TEST_F(ZipMemberTest, AWrongChecksumIsRefused) {
  for (ZipPart part : {test::stored_part("a.npy", three()), test::deflated_part("a.npy", three())}) {
    part.crc ^= 1U;
    refused(archive_of({part}), ":a: damaged: the checksum (CRC-32) is not that of the archive");
  }
  ZipPart changed = test::stored_part("a.npy", three());
  changed.begin.back() = '\x41';
  refused(archive_of({changed}), ":a: damaged: the checksum (CRC-32) is not that of the archive");
}

TEST_F(ZipMemberTest, SizesThatLieAreRefused) {
  const std::uint64_t size = three().size();
  ZipPart part = test::deflated_part("a.npy", three());
  part.size = size - 8;
  refused(archive_of({part}), ":a: shape (3) of f8 needs more than the file's 2 elements: truncated");
  part = test::deflated_part("a.npy", npy_begin("<f8", "(2,)") + bytes_of(1.0) + bytes_of(2.0) + "behind");
  part.size -= 6;
  refused(archive_of({part}), ":a: damaged: it unpacks to more than the " + std::to_string(part.size) +
                                  " bytes that the archive says");
  part = test::deflated_part("a.npy", three().substr(0, size - 4));
  part.size = size;
  refused(archive_of({part}), ":a: damaged: it unpacks to " + std::to_string(size - 4) + " of the " +
                                  std::to_string(size) + " bytes that the archive says");
  part = test::stored_part("a.npy", three());
  part.size += 8;
  refused(archive_of({part}), ":a: stored, but of " + std::to_string(size) + " bytes in the archive and " +
                                  std::to_string(size + 8) + " outside");
}

TEST_F(ZipMemberTest, WhatCannotBeUnpackedIsRefused) {
  ZipPart part = test::deflated_part("a.npy", three());
  part.begin.resize(part.begin.size() / 2);
  refused(archive_of({part}), ":a: damaged: the packed data end early");
  part = test::deflated_part("a.npy", three());
  part.begin[0] = '\x07';
  refused(archive_of({part}), ":a: damaged: invalid block type");
  part = test::stored_part("a.npy", three());
  part.method = 12;
  refused(archive_of({part}), ":a: packed by ZIP's method 12, which is neither stored nor deflated");
  part = test::stored_part("a.npy", three());
  part.flags = 1;
  refused(archive_of({part}), ":a: the NPZ archive is damaged or encrypted");
}

TEST_F(ZipMemberTest, AnArchiveThatIsCutIsRefused) {
  (void)archive_of({test::stored_part("a.npy", three())}, true);
  const std::string bytes = contents(path("a.npz"));
  for (std::size_t size = 4; size < bytes.size(); ++size) {
    refused(write("b.npz", bytes.substr(0, size)), ": the NPZ archive is damaged or encrypted");
  }
  // Cut while it is read.
  const NpzArchive archive(path("a.npz"));
  const std::unique_ptr<ArrayReader> array = archive.open("a");
  std::filesystem::resize_file(path("a.npz"), 130);
  std::vector<double> values(3);
  test::expect_input_error([&] { array->read_at(0, values); },
                           path("a.npz").string() + ":a: the file ends early");
}

}  // namespace
}  // namespace dtof
