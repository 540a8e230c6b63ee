// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "reproduction/reproduction.hpp"

namespace dtof {

struct ReproductionPicture {
  std::string name;  ///< name of the picture's file
  std::vector<PlotSeries> series;
  PlotLayout layout;
};

struct ReproductionReport {
  std::string front_page;  ///< statements and verdicts
  std::string sections;    ///< Markdown; pictures are in the folder `reproduction`
  std::string statements_csv;
  std::string accuracy_csv;
  std::vector<ReproductionPicture> pictures;
};

/// Renders the report. Every sentence with a result is computed from `reproduction`.
ReproductionReport render_reproduction(const Reproduction& reproduction);

}  // namespace dtof
