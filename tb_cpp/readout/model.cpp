// SPDX-License-Identifier: Apache-2.0
#include "readout/model.hpp"

#include "readout/pixelwise_model.hpp"

namespace dtof {

std::unique_ptr<ReadoutModel> make_readout_model(const ReadoutParameters& parameters) {
  parameters.validate();
  switch (parameters.readout) {
    case Readout::kEzPointer:
    case Readout::kHisPointer1:
    case Readout::kHisPointer:
      return make_pointer_readout(parameters);
    case Readout::kSifh:
    case Readout::kFifh:
    case Readout::kThreeSteps:
      return make_interframe_histogram(parameters);
    case Readout::kPifh:
    case Readout::kHistogram:
      return make_partitioned_histogram(parameters);
  }
  throw InputError("unknown read-out number");
}

}  // namespace dtof
