// SPDX-License-Identifier: Apache-2.0
// What the module says to engine="rtl" if it was built without Verilator (no_rtl.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dtof/core/error.hpp"
#include "dtof/recording/stream_csv.hpp"
#include "src/rtl_engine.hpp"

namespace dtof::python {
namespace {

TEST(ModuleWithoutVerilator, SaysHowToHaveRtl) {
  const RecordedStream photons({}, 0, 1);
  EXPECT_THAT([&] { (void)make_rtl_engine(photons, {}, Region(), 0, {}); },
              testing::ThrowsMessage<InputError>(
                  "engine: this module was built without RTL, because verilator was not "
                  "installed (Debian package verilator); install it, and then the "
                  "module again"));
}

}  // namespace
}  // namespace dtof::python
