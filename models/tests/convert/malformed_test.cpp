// SPDX-License-Identifier: Apache-2.0
// Files as they are met in the wild: made here, each with the sentence that it gets.
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "dtof/container/npz.hpp"
#include "dtof/convert/conversion.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/npy.hpp"
#include "tests/container/hdf5_writer.hpp"
#include "tests/container/photon_hdf5_writer.hpp"
#include "tests/container/zip_writer.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using namespace std::string_literals;

struct MalformedFile {
  std::string what;
  std::string name;
  std::string contents;
  std::string out;
  std::string sentence;  ///< behind "<file>: " or "<file>:"
};

class MalformedTest : public test::IoTest {
 protected:
  [[nodiscard]] std::string npz_of(const std::vector<std::string>& names) const {
    NpzWriter writer(path("made.npz"));
    for (const std::string& name : names) {
      writer.add(name, std::vector<std::size_t>{1, 1}, std::vector<double>{1.0});
    }
    writer.commit();
    return contents(path("made.npz"));
  }
  [[nodiscard]] std::string npy_of(const std::vector<std::size_t>& shape,
                                   const std::vector<double>& values) const {
    write_npy(path("made.npy"), shape, values);
    return contents(path("made.npy"));
  }
  [[nodiscard]] std::string zip_of(const test::ZipPart& part) const {
    test::write_zip(path("made.zip"), {part}, false);
    return contents(path("made.zip"));
  }
  [[nodiscard]] std::string gzip_of(const std::string& bytes) const {
    write_gzip_file(path("made.gz"), bytes);
    return contents(path("made.gz"));
  }
  /// Time tags of a HydraHarp: a header's end and so many records of one photon each.
  [[nodiscard]] static std::string ptu_of(std::size_t records) {
    std::string file(
        "PQTTTR\0\0"
        "1.0.00\0\0",
        16);
    for (const auto& [name, type, value] :
         {std::tuple{"TTResultFormat_TTTRRecType", 0x10000008U, std::uint64_t{0x01010304}},
          {"MeasDesc_Resolution", 0x20000008U, std::bit_cast<std::uint64_t>(1e-12)},
          {"Header_End", 0xFFFF0008U, std::uint64_t{0}}}) {
      std::string tag = name;
      tag.resize(48);
      std::memcpy(&tag[36], &type, sizeof type);
      std::memcpy(&tag[40], &value, sizeof value);
      file += tag;
    }
    return file + std::string(4 * records, '\1');
  }
  /// Photon-HDF5 of some photons, the last of them before the laser's pulse where that is asked for.
  [[nodiscard]] std::string photon_hdf5_of(std::size_t photons, bool negative) const {
    std::vector<std::int64_t> times(photons, 1);
    {
      const test::PhotonHdf5Writer file(path("made.h5"));
      file.array("/photon_data/timestamps", times);
      times.back() = negative ? -1 : 1;
      file.array("/photon_data/nanotimes", times);
      file.number("/photon_data/nanotimes_specs/tcspc_unit", 1e-12);
    }
    return contents(path("made.h5"));
  }
  /// HDF5 of 5000 x 1000 numbers with a checksum for each thousand rows; that of the last ones is wrong.
  [[nodiscard]] std::string hdf5_of_wrong_checksum() const {
    std::vector<double> values(5'000'000, 1.0);
    values.back() = 0x1.23456789abcdep9;
    test::write_hdf5(path("made.h5"), {5000, 1, 1000}, values, H5T_IEEE_F64LE,
                     {.chunk = {1000, 1, 1000}, .fletcher32 = true});
    std::string file = contents(path("made.h5"));
    file[file.find(test::bytes_of(values.back()))] ^= 1;
    return file;
  }
  [[nodiscard]] std::vector<MalformedFile> table() const;
  [[nodiscard]] std::vector<MalformedFile> archives() const;
  [[nodiscard]] std::vector<MalformedFile> datasets() const;
  void expect_sentence(const MalformedFile& one) const;
};

std::vector<MalformedFile> MalformedTest::table() const {
  const std::string npz = npz_of({"depth_m"});
  const std::string npy = npy_of({2, 2}, {1.0, 2.0, 3.0, 4.0});
  const std::string mat5 =
      std::string("MATLAB 5.0 MAT-file") + std::string(128 - 19 - 4, ' ') + std::string("\x00\x01IM", 4);
  return {
      {"nothing in it", "a.npy", "", "a.npz", " the file is empty"},
      {"a name that lies", "a.npz", "<html>404 Not Found</html>", "a.npy",
       " unknown kind of recording; name it with --format"},
      {"NPY cut by a full disk", "a.npy", npy.substr(0, npy.size() - 3), "a.npz",
       " shape (2, 2) of f8 needs more than the file's 3 elements: truncated"},
      {"NPY with a second file behind", "a.npy", npy + npy, "a.npz",
       " shape (2, 2) of f8 needs 32 bytes, the file has 192"},
      {"NPY of objects", "a.npy",
       "\x93NUMPY\x01\x00\x46\x00"
       "{'descr': '|O', 'fortran_order': False, 'shape': (1,), }             \n"s,
       "a.npz",
       " dtype '|O' is not one of i1, i2, i4, i8, u1, u2, u4, u8, f2, f4, f8, little- or big-endian"},
      {"NPZ cut by a lost connection", "a.npz", npz.substr(0, npz.size() / 3), "a.npy",
       " the NPZ archive is damaged or encrypted"},
      {"NPZ of nothing", "a.npz", npz_of({}), "a.npy", " the NPZ archive has no array"},
      {"NPZ of two arrays", "a.npz", npz_of({"a", "b"}), "a.npy",
       " the archive has 2 arrays (a, b); name one, as FILE:a"},
      {"HDF5 cut after its signature", "a.h5", std::string("\x89HDF\r\n\x1a\n", 8) + std::string(20, '\0'),
       "a.npy", " the HDF5 file is damaged or ends early"},
      {"MAT without variables", "a.mat", mat5, "a.npy",
       " the variable \"photon_times\" is missing or damaged"},
      {"MAT cut in a variable", "a.mat", mat5 + std::string("\x0e\x00\x00\x00\xff\x00\x00\x00", 8), "a.npy",
       " damaged: the variable at byte 128 ends beyond the file; \"photon_times\" was asked for"},
      {"MAT of a big-endian machine", "a.mat", mat5.substr(0, 124) + std::string("\x01\x00MI", 4), "a.npy",
       " not a little-endian MATLAB 5 file (save with -v7 or -v6)"},
      {"a map whose unknown pixels are -1", "a.npy", npy_of({1, 2}, {1.0, -1.0}), "a.pcd",
       " column 1, row 0: negative depth -1 m"},
      {"histograms where a map is asked for", "a.npy", npy_of({2, 2, 2}, std::vector<double>(8, 1.0)),
       "a.ply", " NPY shape (2, 2, 2): a map has rows and columns, each 1..65535"},
      {"PNG cut by a camera", "a.png", "\x89PNG\r\n\x1a\n", "a.pfm", " damaged PNG: the file ends early"},
      {"PFM of colours", "a.pfm", "PF\n1 1\n-1\n000000000000", "a.npy",
       " colour PFM: a map must be a greyscale PFM (\"Pf\")"},
      {"a stream of another program", "a.csv", "acquisition,column,row,time\n0,0,0,1\n", "a.npy",
       "1: the header must be \"acquisition,column,row,timestamp\""},
      {"a stream with a fraction", "a.csv", "acquisition,column,row,timestamp\n0,0,0,1.5\n", "a.npy",
       "2: timestamp \"1.5\" is not a decimal integer"},
      {"gzip cut by a lost connection", "a.npy.gz", gzip_of(npy).substr(0, 40), "a.npz",
       " damaged gzip data: the file ends early"},
      {"JSON cut by a switched-off logger", "a.json", "[{\"hists\": [1, 2", "a.npy",
       " parse error at line 1, column 17: syntax error while parsing array - unexpected end of input; "
       "expected ']'"},
      {"time tags cut in a record, behind a megabyte of output", "a.ptu", ptu_of(200000) + "x", "a.csv",
       " the file ends in record 200000"},
      {"Photon-HDF5 with a photon before the pulse, behind a megabyte of output", "a.hdf5",
       photon_hdf5_of(200000, true), "a.csv", " /photon_data/nanotimes: element 199999 is negative, -1"},
      {"Photon-HDF5 cut by a full disk", "a.hdf5", photon_hdf5_of(2000, false).substr(0, 20000), "a.csv",
       " the HDF5 file is damaged or ends early"},
      {"time tags cut in the header", "a.ptu",
       std::string("PQTTTR\0\0"
                   "1.0.00\0\0",
                   16),
       "a.csv", " the file ends in its header"},
  };
}

std::vector<MalformedFile> MalformedTest::archives() const {
  const std::string wrong = "a: damaged: the checksum (CRC-32) is not that of the archive";
  const std::string array = test::npy_begin("<f8", "(1, 2, 2)") + std::string(32, '\0');
  const std::string size = std::to_string(array.size());
  test::ZipPart wrong_byte = test::stored_part("a.npy", array);
  wrong_byte.begin[array.size() - 2] = '\x40';
  test::ZipPart late_wrong_byte =
      test::stored_part("a.npy", test::npy_begin("|u1", "(300000,)") + std::string(300000, '\1'));
  late_wrong_byte.begin.back() = '\2';
  test::ZipPart wrong_checksum = test::deflated_part("a.npy", array);
  wrong_checksum.crc ^= 1U;
  test::ZipPart cut = test::deflated_part("a.npy", array);
  cut.begin.resize(cut.begin.size() - 8);
  test::ZipPart too_long = test::deflated_part("a.npy", array + "behind");
  too_long.size = array.size();
  test::ZipPart two_sizes = test::stored_part("a.npy", array);
  two_sizes.size += 8;
  test::ZipPart lzma = test::stored_part("a.npy", array);
  lzma.method = 14;
  return {
      {"a wrong byte, stored", "a.npz", zip_of(wrong_byte), "a.npy", wrong},
      {"a wrong byte, as photons", "a.npz", zip_of(wrong_byte), "a.csv", wrong},
      {"a wrong byte behind a megabyte of output", "a.npz", zip_of(late_wrong_byte), "a.npz", wrong},
      {"another checksum, deflated", "a.npz", zip_of(wrong_checksum), "a.npy", wrong},
      {"deflated data that end early", "a.npz", zip_of(cut), "a.npy",
       "a: damaged: the packed data end early"},
      {"an array longer than the archive says", "a.npz", zip_of(too_long), "a.npy",
       "a: damaged: it unpacks to more than the " + size + " bytes that the archive says"},
      {"a stored array of two sizes", "a.npz", zip_of(two_sizes), "a.npy",
       "a: stored, but of " + size + " bytes in the archive and " + std::to_string(two_sizes.size) +
           " outside"},
      {"an archive of another packer", "a.npz", zip_of(lzma), "a.npy",
       "a: packed by ZIP's method 14, which is neither stored nor deflated"},
  };
}

std::vector<MalformedFile> MalformedTest::datasets() const {
  const std::string wrong = hdf5_of_wrong_checksum();
  const std::string damaged = " /a: the dataset is damaged, or packed by a filter that is not here";
  return {
      {"HDF5 cut by a full disk", "a.h5", wrong.substr(0, wrong.size() / 2), "a.npy",
       " the HDF5 file is damaged or ends early"},
      {"a wrong byte behind a megabyte of output", "a.h5", wrong, "a.npy", damaged},
      {"a wrong byte behind a megabyte of output, packed", "a.h5", wrong, "a.npz", damaged},
      {"a wrong byte, as photons", "a.h5", wrong, "a.csv", damaged},
  };
}

void MalformedTest::expect_sentence(const MalformedFile& one) const {
  SCOPED_TRACE(one.what);
  const std::filesystem::path file = write(one.name, one.contents);
  std::string sentence = one.sentence;
  if (const std::size_t at = sentence.find("FILE"); at != std::string::npos) {
    sentence.replace(at, 4, file.string());
  }
  ConversionOptions options{.out = path("out" + one.out).string(), .recording = {.file = file.string()}};
  if (one.out == "a.csv" && (one.name == "a.npz" || one.name == "a.h5")) {
    options.recording.bin_width_s = 1e-9;
  }
  const std::size_t files = file_count();
  test::expect_input_error([&] { (void)convert(options, open_conversion(options)); },
                           file.string() + ":" + sentence);
  EXPECT_EQ(file_count(), files);
  std::filesystem::remove(file);
}

TEST_F(MalformedTest, EachFileHasItsSentenceAndLeavesNoOutput) {
  for (const MalformedFile& one : table()) {
    expect_sentence(one);
  }
}

TEST_F(MalformedTest, EachArchiveHasItsSentenceAndLeavesNoOutput) {
  for (const MalformedFile& one : archives()) {
    expect_sentence(one);
  }
}

TEST_F(MalformedTest, EachDatasetHasItsSentenceAndLeavesNoOutput) {
  for (const MalformedFile& one : datasets()) {
    expect_sentence(one);
  }
}

}  // namespace
}  // namespace dtof
