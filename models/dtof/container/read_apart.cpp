// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/read_apart.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <exception>
#include <optional>
#include <string_view>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kMostAtOnce = std::size_t{1} << 20U;

/// What a byte of the child says of what follows it.
enum class Reply : char { kAnswer = 'A', kRefusal = 'R', kPiece = 'P', kEnd = 'E' };

/// Writes into the pipe; the child ends where nobody reads.
class Sender {
 public:
  explicit Sender(int descriptor) : descriptor_(descriptor) {}

  void bytes(const void* data, std::size_t count) const {
    const char* next = static_cast<const char*>(data);
    while (count > 0) {
      const ssize_t written = ::write(descriptor_, next, std::min(count, kMostAtOnce));
      if (written < 0 && errno == EINTR) {
        continue;
      }
      if (written <= 0) {
        ::_exit(1);
      }
      next += written;
      count -= static_cast<std::size_t>(written);
    }
  }
  void reply(Reply value) const { bytes(&value, sizeof value); }
  void number(std::uint64_t value) const { bytes(&value, sizeof value); }
  void text(std::string_view text) const {
    number(text.size());
    bytes(text.data(), text.size());
  }

 private:
  int descriptor_;
};

/// Reads from the pipe; `whole` is false once the child has said less than it should have.
class Receiver {
 public:
  explicit Receiver(int descriptor) : descriptor_(descriptor) {}

  void bytes(void* data, std::size_t count) {
    char* next = static_cast<char*>(data);
    while (count > 0 && whole) {
      const ssize_t read = ::read(descriptor_, next, std::min(count, kMostAtOnce));
      if (read < 0 && errno == EINTR) {
        continue;
      }
      whole = read > 0;
      next += std::max<ssize_t>(read, 0);
      count -= static_cast<std::size_t>(std::max<ssize_t>(read, 0));
    }
  }
  /// None once the child has said too little.
  std::optional<Reply> reply() {
    Reply value = Reply::kEnd;
    bytes(&value, sizeof value);
    return whole ? std::optional(value) : std::nullopt;
  }
  /// A number of things that follow.
  std::size_t number() {
    std::uint64_t value = 0;
    bytes(&value, sizeof value);
    return whole ? static_cast<std::size_t>(value) : 0;
  }
  std::string text() {
    std::string text(number(), '\0');
    bytes(text.data(), text.size());
    return text;
  }

  bool whole = true;

 private:
  int descriptor_;
};

void send_answer(const Sender& sender, const ReadAnswer& answer) {
  sender.reply(Reply::kAnswer);
  sender.number(answer.sizes.size());
  for (const std::size_t size : answer.sizes) {
    sender.number(size);
  }
  sender.number(answer.values.size());
  sender.bytes(answer.values.data(), answer.values.size() * sizeof(double));
  sender.number(answer.names.size());
  for (const std::string& name : answer.names) {
    sender.text(name);
  }
}

[[noreturn]] void answer_and_end(int descriptor, const std::function<void(const Sender&)>& answer) {
  // A crash of this process is an answer, too: it writes no core, and Control-C ends it.
  const rlimit none{.rlim_cur = 0, .rlim_max = 0};
  ::setrlimit(RLIMIT_CORE, &none);
  for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) {
    std::signal(signal, SIG_DFL);
  }
  std::signal(SIGPIPE, SIG_IGN);
  // What a C library says of its own end is nothing for the user.
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    ::dup2(nowhere, STDERR_FILENO);
  }
  const Sender sender(descriptor);
  try {
    answer(sender);
  } catch (const std::exception& error) {
    sender.reply(Reply::kRefusal);
    sender.text(error.what());
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

ReadAnswer receive_answer(Receiver& receiver) {
  ReadAnswer answer;
  answer.sizes.resize(receiver.number());
  for (std::size_t& size : answer.sizes) {
    size = receiver.number();
  }
  answer.values.resize(receiver.number());
  receiver.bytes(answer.values.data(), answer.values.size() * sizeof(double));
  answer.names.resize(receiver.number());
  for (std::string& name : answer.names) {
    name = receiver.text();
  }
  return answer;
}

/// The process that reads, and the pipe from it.
class Child {
 public:
  Child(const std::filesystem::path& path, const std::function<void(const Sender&)>& answer) : path_(path) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
      fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(errno)));
    }
    process_ = ::fork();
    const int error = errno;
    if (process_ == 0) {
      ::close(ends[0]);
      answer_and_end(ends[1], answer);
    }
    ::close(ends[1]);
    descriptor_ = ends[0];
    if (process_ < 0) {
      ::close(descriptor_);
      fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(error)));
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;
  /// A child that still writes ends, for nobody reads.
  ~Child() {
    ::close(descriptor_);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Throws InputError unless the child has said all, and if it refused.
  void check(const Receiver& receiver, const std::string& refusal) const {
    if (!receiver.whole) {
      fail_in_file(path_, "damaged: the library that reads such files ended without an answer");
    }
    if (!refusal.empty()) {
      throw InputError(refusal);
    }
  }

 private:
  std::filesystem::path path_;
  pid_t process_ = -1;
  int descriptor_ = -1;
};

}  // namespace

ReadAnswer read_apart(const std::filesystem::path& path, const std::function<ReadAnswer()>& read) {
  const Child child(path, [&](const Sender& sender) { send_answer(sender, read()); });
  Receiver receiver(child.descriptor());
  ReadAnswer answer;
  std::string refusal;
  if (receiver.reply() == Reply::kRefusal) {
    refusal = receiver.text();
  } else if (receiver.whole) {
    answer = receive_answer(receiver);
  }
  child.check(receiver, refusal);
  return answer;
}

void read_pieces_apart(const std::filesystem::path& path, const std::function<void(const GivePiece&)>& read,
                       const std::function<void(const ReadPiece&)>& take) {
  const Child child(path, [&](const Sender& sender) {
    read([&](const ReadPiece& piece) {
      sender.reply(Reply::kPiece);
      sender.number(piece.size());
      sender.bytes(piece.data(), piece.size() * sizeof(ReadPiece::value_type));
    });
    sender.reply(Reply::kEnd);
  });
  Receiver receiver(child.descriptor());
  std::optional<Reply> reply = receiver.reply();
  for (; reply == Reply::kPiece; reply = receiver.reply()) {
    ReadPiece piece(receiver.number());
    receiver.bytes(piece.data(), piece.size() * sizeof(ReadPiece::value_type));
    if (receiver.whole) {
      take(piece);
    }
  }
  child.check(receiver, reply == Reply::kRefusal ? receiver.text() : "");
}

}  // namespace dtof
