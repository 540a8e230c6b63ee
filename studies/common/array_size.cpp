// SPDX-License-Identifier: Apache-2.0
#include "common/array_size.hpp"

#include <algorithm>
#include <map>

#include "reproduction/thesis_statements.hpp"

namespace dtof {

SensorModel with_sensors(const SensorModel& sensor, double sensors) {
  SensorModel changed = sensor;
  changed.signal_events_1m *= kThesisSensors / sensors;
  return changed;
}

std::vector<ArrayMargin> array_margins(StudySettings settings, std::span<const double> sensors) {
  settings.distances_m = {0.2, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 2.5, 3.0};
  const SensorModel full_array = settings.sensor;
  std::map<std::string, std::vector<ArrayMargin>> by_estimator;
  std::vector<std::string> order;
  for (const double count : sensors) {
    settings.sensor = with_sensors(full_array, count);
    const AccuracyStudy study = run_accuracy_study(settings);
    for (const AccuracyPoint& point : study.points) {
      std::vector<ArrayMargin>& margins = by_estimator[point.estimator];
      if (margins.empty()) {
        order.push_back(point.estimator);
      }
      if (margins.empty() || margins.back().sensors != count) {
        margins.push_back({point.estimator, point.title, count, 0.0, 0.0});
      }
      const double limit = customer_limit(point.distance_m);
      ArrayMargin& margin = margins.back();
      margin.by_precision = std::max(margin.by_precision, point.relative_precision.value / limit);
      margin.by_rmse = std::max(margin.by_rmse, point.rmse_m.value / point.distance_m / limit);
    }
  }
  std::vector<ArrayMargin> all;
  for (const std::string& estimator : order) {
    std::ranges::copy(by_estimator[estimator], std::back_inserter(all));
  }
  return all;
}

LargestArray largest_array(std::span<const ArrayMargin> margins, double ArrayMargin::*margin) {
  LargestArray result{0.0, 0.0};
  for (const ArrayMargin& tried : margins) {
    if (tried.*margin <= 1.0) {
      result.sensors = std::max(result.sensors, tried.sensors);
    }
  }
  for (const ArrayMargin& tried : margins) {
    if (tried.sensors > result.sensors && (result.too_many == 0.0 || tried.sensors < result.too_many)) {
      result.too_many = tried.sensors;
    }
  }
  return result;
}

}  // namespace dtof
