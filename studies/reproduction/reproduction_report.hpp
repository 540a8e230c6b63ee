// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "reproduction/reproduction.hpp"

namespace dtof {

struct ReproductionPicture {
  std::string name;  ///< of its file
  std::vector<PlotSeries> series;
  PlotLayout layout;
};

struct ReproductionReport {
  std::string front_page;  ///< statements and verdicts
  std::string sections;    ///< Markdown; pictures are looked for in the folder `reproduction`
  std::string statements_csv;
  std::string accuracy_csv;
  std::vector<ReproductionPicture> pictures;
};

/// Every sentence that states a result is computed from `reproduction`.
ReproductionReport render_reproduction(const Reproduction& reproduction);

}  // namespace dtof
