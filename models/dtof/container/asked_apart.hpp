// SPDX-License-Identifier: Apache-2.0
// A process of its own that is asked again and again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "dtof/container/apart_process.hpp"
#include "dtof/container/read_apart.hpp"

namespace dtof {

/// Numbers in memory that this process and its later children share.
class SharedNumbers {
 public:
  /// Throws InputError "<path>: cannot read: <reason>" if there is no memory.
  SharedNumbers(const std::filesystem::path& path, std::size_t count);
  SharedNumbers(const SharedNumbers&) = delete;
  SharedNumbers& operator=(const SharedNumbers&) = delete;
  SharedNumbers(SharedNumbers&&) = delete;
  SharedNumbers& operator=(SharedNumbers&&) = delete;
  ~SharedNumbers();

  [[nodiscard]] std::span<double> all() const { return numbers_; }

 private:
  std::span<double> numbers_;
};

/// Elements of an array that are asked for.
struct ReadRequest {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// A process that opens a file once and answers requests until the object is destroyed. Answers lie in
/// memory that both processes share.
class AskedApart {
 public:
  /// Puts the answer into `room` and returns the number of elements.
  using Answer = std::function<std::size_t(const ReadRequest& request, std::span<double> room)>;
  struct Opened {
    ReadAnswer said;  ///< of the file
    Answer answer;
  };

  /// `open` runs once, `answer` for each request, both in the other process. Throws InputError as read_apart
  /// does. `room` is a number of elements.
  AskedApart(const std::filesystem::path& path, std::size_t room, const std::function<Opened()>& open);

  /// What `open` said of the file.
  [[nodiscard]] const ReadAnswer& opened() const { return opened_; }
  [[nodiscard]] std::span<const double> room() const { return room_.all(); }
  /// Returns what `answer` returns, and throws InputError as `answer` does. `label` is for the message of a
  /// process that ended. One thread may ask at a time.
  std::size_t ask(const std::filesystem::path& label, const ReadRequest& request);

 private:
  SharedNumbers room_;
  ApartProcess process_;
  Receiver receiver_;
  ReadAnswer opened_;
};

}  // namespace dtof
