// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>

#include <set>
#include <vector>

namespace dtof {

/// What the arrays of this program must hold of a parameter's promised values, in increasing order: all in a
/// program of the long lane, both ends and one between them elsewhere.
inline testing::Matcher<const std::set<int>&> hold(const std::vector<int>& promised) {
#ifdef DTOF_EVERY_VALUE
  return testing::IsSupersetOf(promised);
#else
  return testing::AllOf(testing::Contains(promised.front()), testing::Contains(promised.back()),
                        testing::Contains(testing::AnyOfArray(promised.begin() + 1, promised.end() - 1)));
#endif
}

}  // namespace dtof
