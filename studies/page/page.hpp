// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "dtof/report/table.hpp"

namespace dtof {

/// The values that a page shows, by name. A study measures them; the page's template,
/// studies/<room>/<template>.mustache, has the words. A value is a text (numbers are formatted by the study),
/// a flag that shows or hides a section of the template, or a list whose section is repeated for each of its
/// entries. Names are those of the template: `cells` for {{cells}}.
class PageData {
 public:
  using Value = std::variant<std::string, bool, std::vector<PageData>>;

  /// Sets a text by a format and its arguments. A name that is already set throws std::logic_error, here and
  /// below.
  template <typename... Args>
  // clang-tidy 14 does not notice that the name is moved. NOLINTNEXTLINE(performance-unnecessary-value-param)
  PageData& set(std::string name, fmt::format_string<Args...> format, Args&&... args) {
    return add(std::move(name), fmt::format(format, std::forward<Args>(args)...));
  }
  PageData& set(std::string name, const Table& table) {
    return add(std::move(name), without_end(table.markdown()));
  }
  PageData& flag(std::string name, bool is_set) { return add(std::move(name), is_set); }
  PageData& list(std::string name, std::vector<PageData> entries) {
    return add(std::move(name), std::move(entries));
  }

  /// A section that is shown once, or not at all: a list of at most one entry.
  PageData& part(std::string name, std::optional<PageData> shown);

  [[nodiscard]] const std::vector<std::pair<std::string, Value>>& values() const { return values_; }
  bool operator==(const PageData&) const = default;

 private:
  PageData& add(std::string name, Value value);
  /// Without the last line's end, which the template has.
  static std::string without_end(std::string text);

  std::vector<std::pair<std::string, Value>> values_;
};

/// Fills a template (Mustache, nothing escaped). Throws std::logic_error, which names the template's value
/// that the data lacks, or the value of the data that the template does not use.
std::string render_page(const std::string& text, const PageData& data);

/// Fills the template `name` of the program. Throws std::logic_error if the program has none.
std::string page_text(std::string_view name, const PageData& data);

/// A page's data with the name of its template, as kept beside the page.
struct StoredPage {
  std::string page_template;
  PageData data;
};
/// JSON of the data: {"template": name, "data": {...}}.
std::string page_json(std::string_view name, const PageData& data);
/// Reads what page_json wrote. Throws InputError, which names `file`.
StoredPage parse_page_json(const std::string& json, const std::filesystem::path& file);

/// Writes the page <folder>/<stem>.md and its data <folder>/<stem>.page.json.
void write_page(const std::filesystem::path& folder, const std::string& stem, std::string_view page_template,
                const PageData& data);

}  // namespace dtof
