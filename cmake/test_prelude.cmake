# SPDX-License-Identifier: Apache-2.0
#
#   dtof_test_prelude(<test>)
#
# gives a test program the headers that nearly every test includes, compiled once for all tests. The tests include what they use all
# the same: a compiler other than GCC, and a build without DTOF_UNITY (clang-tidy), read the headers themselves. ccache keeps such a
# test only with the option for headers without times (CCACHE_SLOPPINESS).

function(dtof_test_prelude test)
  if(NOT DTOF_UNITY OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    return()
  endif()
  if(NOT TARGET dtof_test_prelude)
    file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/test_prelude.cpp CONTENT "")
    add_library(dtof_test_prelude OBJECT ${PROJECT_BINARY_DIR}/test_prelude.cpp)
    dtof_test_options(dtof_test_prelude)
    target_compile_features(dtof_test_prelude PRIVATE cxx_std_20)
    target_link_libraries(dtof_test_prelude PRIVATE GTest::gmock fmt::fmt)
    target_precompile_headers(dtof_test_prelude PRIVATE <gmock/gmock.h> <gtest/gtest.h> <fmt/format.h> <algorithm> <array> <cmath>
      <filesystem> <fstream> <functional> <map> <memory> <numeric> <random> <set> <span> <sstream> <string> <vector>)
  endif()
  target_precompile_headers(${test} REUSE_FROM dtof_test_prelude)
endfunction()
