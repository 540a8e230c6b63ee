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
#include "rtl/configuration.hpp"

namespace dtof {

/// Inputs of a product.
struct ProductRequest {
  std::string sensor_text;  ///< text of the sensor file
  SensorModel sensor;
  ReadoutParameters parameters;
  int pointer_ports = 2;  ///< POINTER_PORTS: 2, or 1 for a read-out with pointers and SLOTS of at least 2
  /// Columns of the sensor that share an SRAM, one after the other (FoldedSource): 1 to the sensor's columns;
  /// 1 for a pool read-out.
  int columns_per_sram = 1;
  Scene scene = Scene::kRoom;  ///< scene of the test vectors
  double klux = 14.0;
  std::uint64_t seed = 1;
  std::uint32_t vector_acquisitions = 0;  ///< 0: the sensor's number, limited to a few megabytes of vectors
  bool self_test = false;  ///< with dtof_self_test, whose expected checksum is in driver and bench
  FrameBudget budget;
  int threads = 0;
  std::string command;       ///< command that made the product, without options that do not change its files
  std::string measurements;  ///< Markdown with measured figures; empty if nothing was measured
};

/// The product's array. Throws InputError for numbers of ports and of columns for each SRAM that its read-out
/// cannot have.
RtlConfiguration product_array(const ProductRequest& request);

/// Whether a frame of the product's array fits its clock and frame rate.
FrameFit product_fit(const ProductRequest& request);

/// Files of a product by path: top, RTL, file lists, constraints, driver, vectors, bench. Equal requests give
/// equal bytes. Throws InputError for parameters that dtof_subsystem does not support, or a frame that does
/// not fit the clock.
std::map<std::string, std::string> product_files(const ProductRequest& request);

/// Throws InputError if `folder` exists and is anything but an empty folder; a symbolic link is not one.
void check_product_folder(const std::filesystem::path& folder);

/// Writes the files into `folder`, which must be empty or not exist: all of them or none.
void write_product(const std::map<std::string, std::string>& files, const std::filesystem::path& folder);

}  // namespace dtof
