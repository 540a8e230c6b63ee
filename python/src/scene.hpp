// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "dtof/photon/target_map.hpp"

namespace dtof::python {

/// A scene as Python holds it: arrays may show its map.
struct SceneMap {
  SceneMap(TargetMap map, std::string called)
      : targets(std::make_shared<const TargetMap>(std::move(map))), name(std::move(called)) {}

  std::shared_ptr<const TargetMap> targets;
  std::string name;
};

}  // namespace dtof::python
