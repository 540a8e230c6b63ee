// SPDX-License-Identifier: Apache-2.0
// Written by scripts/generate.py from readouts.toml.
// clang-format off
#include "dtof/core/error.hpp"
#include "dtof/readout/pixelwise_model.hpp"

namespace dtof {

std::unique_ptr<ReadoutModel> make_pointer_readouts(const ReadoutParameters& parameters);
std::unique_ptr<ReadoutModel> make_interframe_histogram(const ReadoutParameters& parameters);
std::unique_ptr<ReadoutModel> make_partitioned_histogram(const ReadoutParameters& parameters);
std::unique_ptr<ReadoutModel> make_coarse_histogram(const ReadoutParameters& parameters);
std::unique_ptr<ReadoutModel> make_pool_pointer(const ReadoutParameters& parameters);

std::unique_ptr<ReadoutModel> make_ungated_model(const ReadoutParameters& parameters) {
  switch (parameters.readout) {
    case Readout::kEzPointer:
    case Readout::kHisPointer1:
    case Readout::kHisPointer:
      return make_pointer_readouts(parameters);
    case Readout::kSifh:
    case Readout::kFifh:
    case Readout::kThreeSteps:
      return make_interframe_histogram(parameters);
    case Readout::kPifh:
    case Readout::kHistogram:
      return make_partitioned_histogram(parameters);
    case Readout::kCoarseHistogram:
      return make_coarse_histogram(parameters);
    case Readout::kPoolPointer:
    case Readout::kPoolPointerLean:
      return make_pool_pointer(parameters);
  }
  throw InputError("unknown read-out number");
}

}  // namespace dtof
