// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "page/page.hpp"
#include "reproduction/reproduction.hpp"

namespace dtof {

struct ReproductionPicture {
  std::string name;  ///< name of the picture's file
  std::vector<PlotSeries> series;
  PlotLayout layout;
};

struct ReproductionReport {
  PageData page;  ///< of reproduction.mustache; pictures are in the folder `reproduction`
  std::string statements_csv;
  std::string accuracy_csv;
  std::vector<ReproductionPicture> pictures;
};

/// The report. Every sentence with a result follows from `reproduction`.
ReproductionReport render_reproduction(const Reproduction& reproduction, const std::string& command_line);

/// Statements and verdicts: what the page has before its first section.
std::string front_page(const ReproductionReport& report);

}  // namespace dtof
