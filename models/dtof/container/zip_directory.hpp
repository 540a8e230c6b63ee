// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dtof/io/byte_source.hpp"

namespace dtof {

/// A member of a ZIP archive, as the archive's central directory says.
struct ZipMember {
  std::string name;
  std::uint16_t method = 0;  ///< 0: stored, 8: deflated
  bool encrypted = false;
  std::uint32_t checksum = 0;     ///< CRC-32 of the unpacked bytes
  std::uint64_t packed_size = 0;  ///< bytes in the archive
  std::uint64_t size = 0;         ///< bytes, unpacked
  std::uint64_t local_header_at = 0;
};

/// Reads the central directory of an archive of any length, with ZIP64 (PKWARE's APPNOTE.TXT, 4.3 and 4.5).
/// Returns the members in the order in which they lie in the archive, without folders. `path` is for
/// messages. Throws InputError "<path>: ..." for a damaged archive, one of several disks, and more than 65536
/// members.
std::vector<ZipMember> read_zip_directory(const std::filesystem::path& path, const ByteSource& archive);

/// Opens a member that is stored or deflated; a stored one can be read at any place. `label` is for messages.
/// Throws InputError "<label>: ..." for an encrypted member, another method, and a member that ends beyond
/// the archive.
std::unique_ptr<ByteSequence> open_zip_member(const std::filesystem::path& label,
                                              std::shared_ptr<const ByteSource> archive,
                                              const ZipMember& member);

}  // namespace dtof
