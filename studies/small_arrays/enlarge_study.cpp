// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/enlarge_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "small_arrays/models/enlarger.hpp"
#include "small_arrays/models/intensity_image.hpp"
#include "small_arrays/models/learned_enlarger.hpp"
#include "small_arrays/models/spot_grid.hpp"
#include "small_arrays/small_array.hpp"

namespace dtof {
namespace {

struct Enlarger {
  const char* title;
  std::vector<double> (*enlarge)(const SmallMap& map, const IntensityImage& image,
                                 const EnlargerWeights& weights);
};

constexpr std::array<Enlarger, 4> kEnlargers = {
    {{"nearest", [](const SmallMap& map, const IntensityImage& /*image*/,
                    const EnlargerWeights& /*weights*/) { return enlarge_nearest(map); }},
     {"bilinear", [](const SmallMap& map, const IntensityImage& /*image*/,
                     const EnlargerWeights& /*weights*/) { return enlarge_bilinear(map); }},
     {"joint bilateral",
      [](const SmallMap& map, const IntensityImage& image, const EnlargerWeights& weights) {
        return enlarge_joint_bilateral(map, image, weights.joint_bilateral);
      }},
     {kLearned, enlarge_learned}}};

SmallMap without_error(const TargetMap& targets, const SpotGrid& grid) {
  const TargetMap spots = spots_of(targets, grid);
  SmallMap map{grid, {}, {}};
  for (int row = 0; row < spots.rows(); ++row) {
    for (int column = 0; column < spots.columns(); ++column) {
      map.distance_m.push_back(spots.at(column, row).depth_m);
      map.confidence.push_back(1.0);
    }
  }
  return map;
}

SceneTruth judged_truth(const EnlargeScene& scene) {
  SceneTruth truth = scene_truth({scene.name, scene.targets, scene.targets.columns()});
  for (std::size_t i = 0; i < scene.guessed.size(); ++i) {
    if (scene.guessed[i]) {
      truth.distance_m[i] = 0.0;
    }
  }
  return truth;
}

SceneScore score(const SceneTruth& truth, const std::vector<double>& distance_m) {
  return score_scene(truth, {distance_m, std::vector<double>(distance_m.size(), 1.0)});
}

}  // namespace

ArraySize parse_array_size(const std::string& text) {
  ArraySize size;
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto number = [](std::string_view digits, int& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size() && value > 0;
  };
  const std::string_view view(text);
  if (cross == text.size() || !number(view.substr(0, cross), size.columns) ||
      !number(view.substr(cross + 1), size.rows)) {
    throw InputError(fmt::format("array '{}': expected COLUMNSxROWS, such as 100x80", text));
  }
  return size;
}

std::string array_size_title(const ArraySize& size) {
  return fmt::format("{} x {}", size.columns, size.rows);
}

std::vector<std::string> enlarger_titles() {
  std::vector<std::string> titles;
  titles.reserve(kEnlargers.size());
  for (const Enlarger& enlarger : kEnlargers) {
    titles.emplace_back(enlarger.title);
  }
  return titles;
}

void check_enlarge_settings(const EnlargeSettings& settings) {
  const ArraySize large{settings.sensor.columns, settings.sensor.rows};
  for (const ArraySize& size : settings.arrays) {
    (void)make_spot_grid(large.columns, large.rows, size.columns, size.rows);
    if (size == large) {
      throw InputError(fmt::format("a small array of {} is the large one", array_size_title(size)));
    }
  }
  for (const std::string& name : settings.readouts) {
    check_small_readout(name, settings.sensor);
  }
}

EnlargeStudy run_enlarge_study(const EnlargeSettings& settings, std::span<const EnlargeScene> scenes) {
  const ArraySize large{settings.sensor.columns, settings.sensor.rows};
  for (const EnlargeScene& scene : scenes) {
    if (scene.targets.columns() != large.columns || scene.targets.rows() != large.rows) {
      throw InputError(fmt::format("{}: {} x {} pixels are not the {} of the large array", scene.name,
                                   scene.targets.columns(), scene.targets.rows(), array_size_title(large)));
    }
  }
  const auto make_array = [&](const ArraySize& size, std::span<const std::string> readouts) {
    return SmallArray(settings.sensor, make_spot_grid(large.columns, large.rows, size.columns, size.rows),
                      settings.klux, readouts, settings.seed, settings.threads);
  };
  check_enlarge_settings(settings);
  Progress progress(fmt::format("{:g} klux", settings.klux),
                    1 + scenes.size() * static_cast<std::size_t>(settings.seeds));
  const SmallArray large_array = make_array(large, std::span(&settings.large_readout, 1));
  std::vector<SmallArray> small_arrays;
  for (const ArraySize& size : settings.arrays) {
    small_arrays.push_back(make_array(size, settings.readouts));
  }
  progress.advance();

  EnlargeStudy study;
  for (const EnlargeScene& scene : scenes) {
    const SceneTruth truth = judged_truth(scene);
    std::vector<EnlargeRow> rows = {{scene.name, large, large_array.titles().front(), kNotEnlarged, {}}};
    for (const SmallArray& array : small_arrays) {
      const ArraySize size{array.grid().small_columns(), array.grid().small_rows()};
      std::vector<std::string> readouts = array.titles();
      readouts.emplace_back(kNoError);
      for (const std::string& readout : readouts) {
        for (const Enlarger& enlarger : kEnlargers) {
          rows.push_back({scene.name, size, readout, enlarger.title, {}});
        }
      }
    }
    for (int i = 0; i < settings.seeds; ++i) {
      const std::uint64_t seed = settings.seed + static_cast<std::uint64_t>(i);
      const bool pictured = i == 0 && scene.name == settings.pictured_scene;
      const IntensityImage image = draw_intensity_image(settings.sensor, scene.targets, settings.klux, seed);
      std::vector<SmallMap> maps;  // in the order of the rows, without the enlargers
      for (const SmallArray& array : small_arrays) {
        for (SmallMap& map : array.measure(scene.targets, seed)) {
          maps.push_back(std::move(map));
        }
        maps.push_back(without_error(scene.targets, array.grid()));
      }
      std::vector<std::vector<double>> enlarged(rows.size());
      enlarged.front() = large_array.measure(scene.targets, seed).front().distance_m;
      parallel_for(rows.size() - 1, settings.threads, [&](std::size_t n) {
        enlarged[n + 1] =
            kEnlargers[n % kEnlargers.size()].enlarge(maps[n / kEnlargers.size()], image, settings.weights);
      });
      if (pictured) {
        study.maps.push_back({"truth", truth.distance_m});
      }
      for (std::size_t n = 0; n < rows.size(); ++n) {
        rows[n].seeds.push_back(score(truth, enlarged[n]));
        const bool shown =
            n == 0 || (rows[n].array == settings.pictured_array && rows[n].readout == rows.front().readout);
        if (pictured && shown) {
          study.maps.push_back({fmt::format("{}{}{}", array_size_title(rows[n].array), n == 0 ? "" : ", ",
                                            n == 0 ? "" : rows[n].enlarger),
                                enlarged[n]});
        }
      }
      progress.advance();
    }
    std::ranges::move(rows, std::back_inserter(study.rows));
  }
  return study;
}

}  // namespace dtof
