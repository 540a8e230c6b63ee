// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/utf8.hpp"

#include <gtest/gtest.h>

namespace dtof {
namespace {

TEST(AsUtf8, WhatIsUtf8Stays) {
  for (const char* text : {"", "plain", "m\u00fcng", "\u20ac 5", "\U0001F600", "\uFFFD"}) {
    EXPECT_EQ(as_utf8(text), text);
  }
}

TEST(AsUtf8, OtherBytesAreLatin1) {
  EXPECT_EQ(as_utf8("mess\xfcng.npy"), "mess\u00fcng.npy");
  EXPECT_EQ(as_utf8("\xfc"), "\u00fc");
  EXPECT_EQ(as_utf8("\xc3"), "\u00c3");  // begins a sequence that does not come
  EXPECT_EQ(as_utf8("\xc3z"), "\u00c3z");
  EXPECT_EQ(as_utf8("\xc0\x80"), "\u00c0\u0080");            // too long for its letter
  EXPECT_EQ(as_utf8("\xed\xa0\x80"), "\u00ed\u00a0\u0080");  // half of a pair of UTF-16
  EXPECT_EQ(as_utf8("\xf5\x80\x80\x80"), "\u00f5\u0080\u0080\u0080");
  EXPECT_EQ(as_utf8("\xe2\x82\xac\xff"), "\u20ac\u00ff");
}

}  // namespace
}  // namespace dtof
