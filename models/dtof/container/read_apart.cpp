// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/read_apart.hpp"

#include <optional>

#include "dtof/container/apart_process.hpp"

namespace dtof {

ReadAnswer read_apart(const std::filesystem::path& path, const std::function<ReadAnswer()>& read) {
  const ApartProcess child(path, [&](int socket) { send_answer(Sender(socket), read()); });
  Receiver receiver(child.descriptor());
  return receive_answer(path, receiver);
}

void read_pieces_apart(const std::filesystem::path& path, const std::function<void(const GivePiece&)>& read,
                       const std::function<void(const ReadPiece&)>& take) {
  const ApartProcess child(path, [&](int socket) {
    const Sender sender(socket);
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
  check_answer(path, receiver, reply == Reply::kRefusal ? receiver.text() : "");
}

}  // namespace dtof
