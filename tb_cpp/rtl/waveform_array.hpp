// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <verilated_fst_c.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "dtof/core/error.hpp"
#include "rtl/verilated_array.hpp"

namespace dtof {

/// VerilatedArray for a model that was generated with waveforms.
template <typename Model>
class WaveformArray final : public VerilatedArray<Model> {
 public:
  using VerilatedArray<Model>::VerilatedArray;
  ~WaveformArray() override { close_trace(); }
  WaveformArray(const WaveformArray&) = delete;
  WaveformArray& operator=(const WaveformArray&) = delete;
  WaveformArray(WaveformArray&&) = delete;
  WaveformArray& operator=(WaveformArray&&) = delete;

  void open_trace(const std::filesystem::path& file) override {
    // Verilator reports no error if it cannot create the file.
    if (!std::ofstream(file).is_open()) {
      throw InputError(fmt::format("cannot write trace file '{}'", file.string()));
    }
    trace_ = std::make_unique<VerilatedFstC>();
    this->model().trace(trace_.get(), kAllLevels);
    trace_->open(file.c_str());
  }
  void dump_trace(std::uint64_t time) override { trace_->dump(time); }
  void close_trace() override {
    if (trace_ != nullptr) {
      trace_->close();
      trace_.reset();
    }
  }

 private:
  static constexpr int kAllLevels = 99;
  std::unique_ptr<VerilatedFstC> trace_;
};

}  // namespace dtof
