// SPDX-License-Identifier: Apache-2.0
#include "subsystem/shot_reference.hpp"

namespace dtof {
namespace {

constexpr std::uint64_t kClocksOfARequest = 2;
constexpr int kSteps = 16;

}  // namespace

void ShotReference::step() {
  for (int i = 0; i < kSteps; ++i) {
    std::uint32_t parity = 0;
    for (const std::uint32_t bit : {0U, 2U, 3U, 5U}) {  // x^16 + x^14 + x^13 + x^11 + 1
      parity += state_ >> bit;
    }
    state_ = state_ >> 1U | (parity & 1U) << 15U;
  }
}

bool ShotReference::clock(const ShotClock& now) {
  const bool shot = due_ == now_;
  if (shot) {
    owed_ = true;
    due_.reset();
  }
  const bool wanted = need_ > 0 && queued_ == 0 && !owed_ && !rest_ && !now.early && !now.arrives &&
                      !now.begin && !now.abort && !now.flush && !now.gave_up;
  if (!wanted) {
    due_.reset();
  } else if (!due_) {
    const std::uint32_t units = state_ & ((1U << frame_.bits) - 1U);
    due_ = now_ + kClocksOfARequest + std::uint64_t{units} * frame_.unit;
    if (frame_.bits > 0) {
      step();
    }
  }
  if (now.reseed) {
    state_ = seed_ == 0 ? 1 : seed_;
  }

  if (now.taken) {
    need_ -= need_ > 0 ? 1 : 0;
    queued_ -= draining_ ? 0 : 1;
  }
  if (now.arrives) {
    owed_ = false;
    ++queued_;
  }
  if (now.dropped) {
    --queued_;
  }
  if (now.rest_ends) {
    rest_ = false;
  }
  if (now.done) {
    draining_ = false;
  }
  if (now.begin) {
    frame_ = next_;
    need_ = frame_.acquisitions;
    first_state_ = state_;
  }
  if (now.abort || now.gave_up) {
    need_ = 0;
    draining_ = !now.abort;
  }
  if (now.abort) {
    rest_ = rest_ || now.inside;
  }
  if (now.flush || (now.gave_up && !now.abort)) {
    owed_ = false;
    rest_ = false;
  }
  if (now.abort || now.flush || now.gave_up) {
    queued_ = 0;
  }
  ++now_;
  return shot;
}

}  // namespace dtof
