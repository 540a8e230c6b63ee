// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/lane_memory.hpp"

#include <algorithm>

#include "dtof/core/random.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kContents = 0x4D454DU;  // purpose of these random numbers

std::uint32_t address_in(std::span<const Lanes> values, std::span<const Net> nets, std::size_t lane) {
  std::uint32_t address = 0;
  for (std::size_t i = 0; i < nets.size(); ++i) {
    address |= (values[nets[i]].get(lane) ? 1U : 0U) << i;
  }
  return address;
}

/// Lanes whose address is that of lane 0.
Lanes same_address(std::span<const Lanes> values, std::span<const Net> nets) {
  Lanes differs;
  for (const Net net : nets) {
    differs = differs | (values[net] ^ Lanes::all(values[net].get(0)));
  }
  return ~differs;
}

/// Calls `body(address, lanes)` for the lanes of `enable`: once for those with the address of lane 0, and
/// once for every other lane. Addresses beyond `depth` are left out.
template <typename Body>
void for_each_address(std::span<const Lanes> values, std::span<const Net> nets, std::uint32_t depth,
                      const Lanes& enable, const Body& body) {
  const Lanes together = enable & same_address(values, nets);
  if (together.any()) {
    const std::uint32_t address = address_in(values, nets, 0);
    if (address < depth) {
      body(address, together);
    }
  }
  (enable & ~together).for_each([&](std::size_t lane) {
    const std::uint32_t address = address_in(values, nets, lane);
    if (address < depth) {
      body(address, Lanes::one(lane));
    }
  });
}

}  // namespace

LaneMemory::LaneMemory(const Memory& memory, std::uint64_t seed)
    : memory_(memory),
      bits_(static_cast<std::size_t>(memory.depth) * memory.width()),
      read_data_(memory.width()) {
  CounterRandom random(seed, kContents, 0, 0);
  for (Lanes& bit : bits_) {
    bit = Lanes::all((random() & 1U) != 0);
  }
}

void LaneMemory::clock(std::span<const Lanes> values) {
  const Lanes write_enable = values[memory_.write_enable];
  if (memory_.two_ports) {
    read(values, values[memory_.read_enable], write_enable);
    write(values, write_enable);
  } else {
    const Lanes enable = values[memory_.read_enable];
    read(values, enable & ~write_enable, Lanes());
    write(values, enable & write_enable);
  }
}

void LaneMemory::read(std::span<const Lanes> values, const Lanes& enable, const Lanes& written) {
  const std::size_t width = read_data_.size();
  if (!enable.any()) {
    return;
  }
  for_each_address(values, memory_.read_address, memory_.depth, enable,
                   [&](std::uint32_t address, const Lanes& lanes) {
                     for (std::size_t bit = 0; bit < width; ++bit) {
                       read_data_[bit] = choose(lanes, bits_[address * width + bit], read_data_[bit]);
                     }
                   });
  Lanes collides = enable & written;
  for (std::size_t i = 0; i < memory_.read_address.size() && collides.any(); ++i) {
    collides = collides & ~(values[memory_.read_address[i]] ^ values[memory_.write_address[i]]);
  }
  if (collides.any()) {
    for (Lanes& bit : read_data_) {
      bit = bit ^ collides;
    }
  }
}

void LaneMemory::write(std::span<const Lanes> values, const Lanes& enable) {
  const std::size_t width = read_data_.size();
  if (!enable.any()) {
    return;
  }
  const std::size_t parts = std::max<std::size_t>(memory_.write_parts.size(), 1);
  for_each_address(
      values, memory_.write_address, memory_.depth, enable, [&](std::uint32_t address, const Lanes& lanes) {
        for (std::size_t bit = 0; bit < width; ++bit) {
          const Lanes written =
              memory_.write_parts.empty() ? lanes : lanes & values[memory_.write_parts[bit * parts / width]];
          Lanes& stored = bits_[address * width + bit];
          stored = choose(written, values[memory_.write_data[bit]], stored);
        }
      });
  for (const Stuck& stuck : stuck_) {
    bits_[stuck.bit].set(stuck.lane, stuck.value);
  }
}

void LaneMemory::flip(std::size_t bit, std::size_t lane) { bits_[bit].set(lane, !bits_[bit].get(lane)); }

void LaneMemory::stick(std::size_t bit, std::size_t lane, bool value) {
  stuck_.push_back({bit, lane, value});
  bits_[bit].set(lane, value);
}

}  // namespace dtof
