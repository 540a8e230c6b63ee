// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/apart_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <system_error>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

constexpr std::size_t kMostAtOnce = std::size_t{1} << 20U;

[[noreturn]] void answer_and_end(int descriptor, const std::function<void(int)>& answer) {
  // A crash of this process is an answer, too: it writes no core, and Control-C ends it.
  const rlimit none{.rlim_cur = 0, .rlim_max = 0};
  ::setrlimit(RLIMIT_CORE, &none);
  for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) {
    std::signal(signal, SIG_DFL);
  }
  // What a C library says of its own end is nothing for the user.
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    ::dup2(nowhere, STDERR_FILENO);
  }
  try {
    answer(descriptor);
  } catch (const std::exception& error) {
    const Sender sender(descriptor);
    sender.reply(Reply::kRefusal);
    sender.text(error.what());
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

}  // namespace

bool send_bytes(int descriptor, const void* data, std::size_t count) {
  const char* next = static_cast<const char*>(data);
  while (count > 0) {
    const ssize_t written = ::send(descriptor, next, std::min(count, kMostAtOnce), MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return false;
    }
    next += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

void Sender::bytes(const void* data, std::size_t count) const {
  if (!send_bytes(descriptor_, data, count)) {
    ::_exit(1);
  }
}

void Sender::text(std::string_view text) const {
  number(text.size());
  bytes(text.data(), text.size());
}

void Receiver::bytes(void* data, std::size_t count) {
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

std::optional<Reply> Receiver::reply() {
  Reply value = Reply::kEnd;
  bytes(&value, sizeof value);
  return whole ? std::optional(value) : std::nullopt;
}

std::size_t Receiver::number() {
  std::uint64_t value = 0;
  bytes(&value, sizeof value);
  return whole ? static_cast<std::size_t>(value) : 0;
}

std::string Receiver::text() {
  std::string text(number(), '\0');
  bytes(text.data(), text.size());
  return text;
}

ApartProcess::ApartProcess(const std::filesystem::path& path, const std::function<void(int)>& answer) {
  std::array<int, 2> ends{};
  // Another program that this process starts gets no end of it.
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
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

// A younger child may have a copy of the socket, so that its end alone would not end this child.
ApartProcess::~ApartProcess() {
  ::close(descriptor_);
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void check_answer(const std::filesystem::path& label, const Receiver& receiver, const std::string& refusal) {
  if (!receiver.whole) {
    fail_in_file(label, "damaged: the library that reads such files ended without an answer");
  }
  if (!refusal.empty()) {
    throw InputError(refusal);
  }
}

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

ReadAnswer receive_answer(const std::filesystem::path& path, Receiver& receiver) {
  ReadAnswer answer;
  std::string refusal;
  if (receiver.reply() == Reply::kRefusal) {
    refusal = receiver.text();
  } else if (receiver.whole) {
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
  }
  check_answer(path, receiver, refusal);
  return answer;
}

}  // namespace dtof
