// SPDX-License-Identifier: Apache-2.0
#include "common/readout_variant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ReadoutVariant, ChangesWhatIsNamed) {
  ReadoutParameters expected = ReadoutParameters::defaults(Readout::kHisPointer);
  expected.count_width = 8;
  expected.fraction_bits = 4;
  EXPECT_EQ(parse_variant("hispointer:COUNT_WIDTH=8,FRACTION_BITS=4"), expected);
  EXPECT_TRUE(parse_variant("sifh:WINDOW_CENTRED=1").window_centred);

  const ReadoutParameters pool =
      parse_variant("poolpointer:LABELS=7,SCORE_BITS=3,COARSE_SHARE=12,TRACK_SHARE=14");
  EXPECT_EQ(pool.pool.labels, 7);
  EXPECT_EQ(pool.pool.score_bits, 3);
  EXPECT_EQ(pool.pool.coarse_share, 12);
  EXPECT_EQ(pool.pool.track_share, 14);

  const ReadoutParameters two = parse_variant("poolpointer:COARSE_SHARE=16,SMOOTH=0");
  EXPECT_EQ(two.readout, Readout::kPoolPointer);
  EXPECT_EQ(two.pool.coarse_share, 16);
  EXPECT_FALSE(two.pool.smooth);
}

TEST(ReadoutVariant, TitleNamesTheChanges) {
  EXPECT_EQ(variant_title(parse_variant("hispointer:COUNT_WIDTH=8")), "hisPointer COUNT_WIDTH=8");
  EXPECT_EQ(variant_title(parse_variant("sifh:WINDOW_CENTRED=1,COUNT_WIDTH=12")),
            "SiFH COUNT_WIDTH=12 WINDOW_CENTRED=1");
  EXPECT_EQ(variant_title(parse_variant("poolpointer:LABELS=6,COARSE_SHARE=12")),
            "poolPointer LABELS=6 COARSE_SHARE=12");
  EXPECT_EQ(variant_title(ReadoutParameters::defaults(Readout::kPoolPointer)), "poolPointer");
  EXPECT_EQ(variant_title(parse_variant("poolpointer:LABELS=4,SMOOTH=0")), "poolPointer LABELS=4 SMOOTH=0");
}

// What follows the sensor's pulse is no change.
TEST(ReadoutVariant, CellsFollowThePulse) {
  SensorModel sensor;
  sensor.pulse_fwhm_s = 12 * sensor.time_resolution_s();
  const ReadoutParameters follows = parse_variant("poolpointer:SMOOTH=1", sensor);
  EXPECT_EQ(follows.pool.cell_shift, 8);
  EXPECT_EQ(variant_title(follows, sensor), "poolPointer");
  EXPECT_EQ(variant_title(parse_variant("poolpointer:CELL_SHIFT=9", sensor), sensor),
            "poolPointer CELL_SHIFT=9");
  EXPECT_EQ(parse_variant("poolpointer-lean:SMOOTH=1").pool.cell_shift, 9);
}

TEST(ReadoutVariant, RefusesUnknownNames) {
  const auto parse = [](const std::string& text) { return [text] { (void)parse_variant(text); }; };
  for (const char* text : {"hispointer", "hispointer:", "hispointer:COUNT_WIDTH", "hispointer:COUNT_WIDTH=x",
                           "hispointer:COUNT_WIDTH=8,FRACTION_BITS", "hispointer:COUNT_WIDTH=8,"}) {
    EXPECT_THAT(parse(text), ThrowsMessage<InputError>(HasSubstr("expected READOUT:PARAMETER=NUMBER")))
        << text;
  }
  EXPECT_THAT(parse("nothing:NP=8"), ThrowsMessage<InputError>(HasSubstr("nothing")));
  EXPECT_THAT(parse("hispointer:COARSE_SHARE=8"),
              ThrowsMessage<InputError>(HasSubstr("has no COARSE_SHARE")));
  EXPECT_THAT(parse("poolpointer:FRACTION_BITS=4"),
              ThrowsMessage<InputError>(HasSubstr("has no FRACTION_BITS")));
  EXPECT_THAT(parse("hispointer:SMOOTH=0"),
              ThrowsMessage<InputError>(HasSubstr("hispointer has no SMOOTH to change; known are")));
  EXPECT_THAT(parse("poolpointer:LABELS=9"),
              ThrowsMessage<InputError>(HasSubstr("LABELS must be 2 to 8, not 9")));
  EXPECT_THAT(parse("hispointer:COUNT_WIDTH=99"), ThrowsMessage<InputError>(HasSubstr("COUNT_WIDTH")));
}

}  // namespace
}  // namespace dtof
