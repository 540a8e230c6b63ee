// SPDX-License-Identifier: Apache-2.0
#include "playground/advice.hpp"

#include <gmock/gmock.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "design/design_page.hpp"
#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// A preset's file as a visitor might type it, for a small array and a short frame.
std::string typed() {
  std::string text;
  std::istringstream lines{std::string(preset_text("thesis"))};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("columns")) {
      line = "columns = 36";
    } else if (line.starts_with("rows")) {
      line = "rows = 16";
    } else if (line.starts_with("acquisitions")) {
      line = "acquisitions = 300";
    }
    text += line + "\n";
  }
  return text;
}

/// The lines of each kind, without it.
std::map<std::string, std::vector<std::string>> by_kind(const std::string& text) {
  std::map<std::string, std::vector<std::string>> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    found[line.substr(0, line.find('\t'))].push_back(line.substr(line.find('\t') + 1));
  }
  return found;
}

TEST(PlaygroundAdvice, IsThatOfTheDesignForTheTypedSensor) {
  AdviceRequest request;
  request.most_mm2 = 0.3;
  request.seed = 7;
  std::vector<std::string> steps;
  const PlaygroundFiles files{.sensor_name = "typed.toml", .sensor_text = typed()};
  auto found = by_kind(
      playground_advice(request, files, [&](std::string_view step, std::size_t done, std::size_t total) {
        EXPECT_LE(done, total);
        if (steps.empty() || steps.back() != step) {
          steps.emplace_back(step);
        }
      }));
  EXPECT_EQ(steps, (std::vector<std::string>{"parameters", "read-outs", "contenders"}));

  DesignRequest design;
  design.bench.sensor = parse_sensor(typed(), "typed.toml");
  design.bench.seed = 7;
  design.limits.most_mm2 = 0.3;
  design = quick_design(design);
  const DesignResult result = run_design(design);
  const Table table = design_rows(design, result);
  EXPECT_EQ(found["head"].size(), 1U);
  ASSERT_EQ(found["row"].size(), result.recommendation.within.size());
  EXPECT_THAT(found["row"].front(), HasSubstr(table.cells()[1][1])) << "the best one's errors";
  EXPECT_EQ(found["recommendation"].front() + "\n", design_recommendation(design, result));
  EXPECT_EQ(found["change"].size(), 6U) << "area, frame rate and clock, both ways";
  EXPECT_THAT(found["change"].front(), Not(HasSubstr("* ")));
  EXPECT_EQ(found["clocks"], design_clocks(design, result));
  EXPECT_EQ(found["left"].size(), result.left_out.size());
  const DesignCandidate& chosen = result.options[*result.recommendation.chosen].candidate;
  EXPECT_EQ(found["readout"].front(), readout_name(chosen.readout()));
  EXPECT_EQ(found["product"].front(), product_options(chosen.array, design.bench.sensor));
}

TEST(PlaygroundAdvice, EachLimitReachesTheDesign) {
  const PlaygroundFiles files{.sensor_name = "typed.toml", .sensor_text = typed()};
  for (const auto& [line, option] : std::map<std::string, std::string>{{"max-mm2 0.001", "--max-mm2 "},
                                                                       {"max-mw 0.01", "--max-mw "},
                                                                       {"frame-rate 1e8", "--frame-rate "},
                                                                       {"clock-mhz 1000", "--clock-mhz "}}) {
    EXPECT_THAT([&] { playground_advice(parse_advice_request("seed 1\n" + line), files); },
                ThrowsMessage<InputError>(HasSubstr("one of these would do: " + option)))
        << line;
  }
}

TEST(PlaygroundAdvice, ReadsTheLinesOfARequest) {
  const AdviceRequest request = parse_advice_request("sensor phone\nmax-mw 150\nseed 12");
  EXPECT_EQ(request.sensor, "phone");
  EXPECT_EQ(request.most_mw, 150.0);
  EXPECT_EQ(request.most_mm2, std::nullopt);
  EXPECT_EQ(request.seed, 12U);
  EXPECT_THAT([] { parse_advice_request("klux 3"); },
              ThrowsMessage<InputError>(HasSubstr("'klux' is nothing that a request may say")));
  EXPECT_THAT([] { parse_advice_request("max-mw none"); },
              ThrowsMessage<InputError>(HasSubstr("max-mw: 'none' is no number")));
  PlaygroundFiles wrong{.sensor_name = "typed.toml", .sensor_text = "columns = \"many\"\n"};
  EXPECT_THAT([&] { playground_advice({}, wrong); }, ThrowsMessage<InputError>(HasSubstr("typed.toml")));
}

}  // namespace
}  // namespace dtof
