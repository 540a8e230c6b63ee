// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/commands.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"
#include "page/page.hpp"

namespace dtof {

void add_page_command(CLI::App& app) {
  auto file = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "page", "Prints a report's page again, from the data that its command left: measures nothing");
  command->add_option("file", *file, "data of a page (*.page.json)")->required()->check(CLI::ExistingFile);
  command->callback([file] {
    const StoredPage stored = parse_page_json(read_file(*file), *file);
    try {
      fmt::print("{}", page_text(stored.page_template, stored.data));
    } catch (const std::logic_error& error) {
      throw InputError(fmt::format("{}: {}", *file, error.what()));
    }
  });
}

}  // namespace dtof
