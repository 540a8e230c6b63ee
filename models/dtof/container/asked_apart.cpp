// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/asked_apart.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <string>
#include <system_error>

#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

/// Answers until nobody asks any more.
void answer_requests(int socket, std::span<double> room, const std::function<AskedApart::Opened()>& open) {
  const Sender sender(socket);
  const AskedApart::Opened opened = open();
  send_answer(sender, opened.said);
  std::signal(SIGINT, SIG_IGN);  // the other process may still ask; if it ends, this one ends as well
  Receiver receiver(socket);
  for (ReadRequest request; receiver.bytes(&request, sizeof request), receiver.whole;) {
    try {
      const std::size_t count = opened.answer(request, room);
      sender.reply(Reply::kAnswer);
      sender.number(count);
    } catch (const std::exception& error) {
      sender.reply(Reply::kRefusal);
      sender.text(error.what());
    }
  }
}

}  // namespace

SharedNumbers::SharedNumbers(const std::filesystem::path& path, std::size_t count) {
  void* const memory = ::mmap(nullptr, count * sizeof(double), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) {
    fail_in_file(path, fmt::format("cannot read: {}", std::generic_category().message(errno)));
  }
  numbers_ = {static_cast<double*>(memory), count};
}

SharedNumbers::~SharedNumbers() { ::munmap(numbers_.data(), numbers_.size_bytes()); }

AskedApart::AskedApart(const std::filesystem::path& path, std::size_t room,
                       const std::function<Opened()>& open)
    : room_(path, room),
      process_(path, [&](int socket) { answer_requests(socket, room_.all(), open); }),
      receiver_(process_.descriptor()),
      opened_(receive_answer(path, receiver_)) {}

std::size_t AskedApart::ask(const std::filesystem::path& label, const ReadRequest& request) {
  std::size_t count = 0;
  std::string refusal;
  receiver_.whole = receiver_.whole && send_bytes(process_.descriptor(), &request, sizeof request);
  if (receiver_.reply() == Reply::kRefusal) {
    refusal = receiver_.text();
  } else {
    count = receiver_.number();
  }
  check_answer(label, receiver_, refusal);
  return count;
}

}  // namespace dtof
