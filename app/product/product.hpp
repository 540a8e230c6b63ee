// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "dtof/core/frame_time.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// What a product is made from.
struct ProductRequest {
  std::string sensor_text;  ///< the sensor file
  SensorModel sensor;
  ReadoutParameters parameters;
  Scene scene = Scene::kRoom;  ///< of the vectors
  double klux = 14.0;
  std::uint64_t seed = 1;
  std::uint32_t vector_acquisitions = 0;  ///< 0: as many of the sensor's as fit some megabytes
  FrameBudget budget;
  int threads = 0;
  std::string command;       ///< that made it, without what does not change its files
  std::string measurements;  ///< Markdown of what was measured; empty if nothing was
};

/// The files of a product by their paths: a top, RTL, file lists, constraints, driver, vectors, bench. The
/// same request gives the same bytes. Throws InputError for what dtof_subsystem cannot be, or a frame that
/// does not fit the clock.
std::map<std::string, std::string> product_files(const ProductRequest& request);

/// Writes the files into a folder that must not be there, or be empty: all of them or none.
void write_product(const std::map<std::string, std::string>& files, const std::filesystem::path& folder);

}  // namespace dtof
