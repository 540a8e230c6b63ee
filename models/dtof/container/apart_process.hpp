// SPDX-License-Identifier: Apache-2.0
// The process in which a library reads, and the socket to it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "dtof/container/read_apart.hpp"

namespace dtof {

/// What a byte of the child says of what follows it.
enum class Reply : char { kAnswer = 'A', kRefusal = 'R', kPiece = 'P', kEnd = 'E' };

/// Writes all bytes into a socket; false if nobody reads.
bool send_bytes(int descriptor, const void* data, std::size_t count);

/// Writes from the child; the child ends where nobody reads.
class Sender {
 public:
  explicit Sender(int descriptor) : descriptor_(descriptor) {}

  void bytes(const void* data, std::size_t count) const;
  void reply(Reply value) const { bytes(&value, sizeof value); }
  void number(std::uint64_t value) const { bytes(&value, sizeof value); }
  void text(std::string_view text) const;

 private:
  int descriptor_;
};

/// Reads from the socket; `whole` is false once the other process has said less than it should have.
class Receiver {
 public:
  explicit Receiver(int descriptor) : descriptor_(descriptor) {}

  void bytes(void* data, std::size_t count);
  /// None once the child has said too little.
  std::optional<Reply> reply();
  /// A number of things that follow; 0 once the child has said too little.
  std::size_t number();
  std::string text();

  bool whole = true;

 private:
  int descriptor_;
};

/// A child of this process, and the socket to it.
class ApartProcess {
 public:
  /// Starts the child, which runs `answer` with its end of the socket, sends what `answer` throws as a
  /// refusal, and ends. Throws InputError "<path>: cannot read: <reason>" if there can be no child.
  ApartProcess(const std::filesystem::path& path, const std::function<void(int)>& answer);
  ApartProcess(const ApartProcess&) = delete;
  ApartProcess& operator=(const ApartProcess&) = delete;
  ApartProcess(ApartProcess&&) = delete;
  ApartProcess& operator=(ApartProcess&&) = delete;
  /// Ends the child.
  ~ApartProcess();

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  pid_t process_ = -1;
  int descriptor_ = -1;
};

/// Throws InputError "<label>: damaged: ..." unless the child has said all, and `refusal` if it refused.
void check_answer(const std::filesystem::path& label, const Receiver& receiver, const std::string& refusal);

/// Sends a result out of the child.
void send_answer(const Sender& sender, const ReadAnswer& answer);
/// Receives a result. Throws InputError as read_apart does.
ReadAnswer receive_answer(const std::filesystem::path& path, Receiver& receiver);

}  // namespace dtof
