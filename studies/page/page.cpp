// SPDX-License-Identifier: Apache-2.0
#include "page/page.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "page/templates.hpp"

namespace dtof {
namespace {

namespace mustache = kainjow::mustache;

mustache::data filling(const PageData& data) {
  mustache::data filled{mustache::data::type::object};
  for (const auto& [name, value] : data.values()) {
    if (const auto* const text = std::get_if<std::string>(&value)) {
      filled.set(name, *text);
    } else if (const auto* const is_set = std::get_if<bool>(&value)) {
      filled.set(name, *is_set);
    } else {
      mustache::data list{mustache::data::type::list};
      for (const PageData& entry : std::get<std::vector<PageData>>(value)) {
        list.push_back(filling(entry));
      }
      filled.set(name, list);
    }
  }
  return filled;
}

/// A template's missing value is an error, not an empty text.
class StrictContext : public mustache::context<std::string> {
 public:
  using context::context;
  const mustache::data* get(const std::string& name) const override {
    const mustache::data* const found = context::get(name);
    if (found == nullptr) {
      throw std::logic_error(fmt::format("page: the data has no '{}'", name));
    }
    return found;
  }
};

/// Whether the template has the name in one of its tags: {{name}}, {{#name}}, {{^name}}.
bool has_tag(const std::string& text, const std::string& name) {
  return std::ranges::any_of(std::initializer_list<const char*>{"", "#", "^"}, [&](const char* kind) {
    return text.find(fmt::format("{{{{{}{}}}}}", kind, name)) != std::string::npos;
  });
}

void check_all_used(const std::string& text, const PageData& data) {
  for (const auto& [name, value] : data.values()) {
    if (!has_tag(text, name)) {
      throw std::logic_error(fmt::format("page: the template does not use '{}'", name));
    }
    if (const auto* const entries = std::get_if<std::vector<PageData>>(&value)) {
      for (const PageData& entry : *entries) {
        check_all_used(text, entry);
      }
    }
  }
}

using Json = nlohmann::ordered_json;

/// A text as JSON; one of several lines as an array of them, which a person can read and compare.
Json text_json(const std::string& text) {
  if (text.find('\n') == std::string::npos) {
    return text;
  }
  Json lines = Json::array();
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  if (text.ends_with('\n')) {
    lines.push_back("");
  }
  return lines;
}

Json to_json(const PageData& data) {
  Json json = Json::object();
  for (const auto& [name, value] : data.values()) {
    if (const auto* const text = std::get_if<std::string>(&value)) {
      json[name] = text_json(*text);
    } else if (const auto* const is_set = std::get_if<bool>(&value)) {
      json[name] = *is_set;
    } else {
      json[name] = Json::array();
      for (const PageData& entry : std::get<std::vector<PageData>>(value)) {
        json[name].push_back(to_json(entry));
      }
    }
  }
  return json;
}

PageData from_json(const Json& json) {
  PageData data;
  for (const auto& [name, value] : json.items()) {
    if (value.is_array() && !value.empty() && value.front().is_string()) {
      data.set(name, "{}", fmt::join(value.get<std::vector<std::string>>(), "\n"));
    } else if (value.is_array()) {
      std::vector<PageData> entries;
      std::ranges::transform(value, std::back_inserter(entries), from_json);
      data.list(name, std::move(entries));
    } else if (value.is_boolean()) {
      data.flag(name, value.get<bool>());
    } else {
      data.set(name, "{}", value.get<std::string>());
    }
  }
  return data;
}

/// Not in any page.
constexpr char kLineBegin = '\x01';

/// The template without the ends of lines that have nothing but a section's tag or a comment: such a line is
/// no line of the page. The library would keep the line's end where a section is hidden, and would drop a
/// page's blank line beside a tag. With a character at the begin of each line that stays it does neither.
std::string without_tag_lines(const std::string& text) {
  std::string lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const bool is_tag =
        line.starts_with("{{") && line.find_first_of("#^/!") == 2 && line.find("}}") == line.size() - 2;
    lines += is_tag ? line : kLineBegin + line + '\n';
    begin = end + 1;
  }
  return lines;
}

std::string stem_of(std::string_view path) { return std::filesystem::path(path).stem().string(); }

}  // namespace

PageData& PageData::add(std::string name, Value value) {
  if (std::ranges::any_of(values_, [&](const auto& one) { return one.first == name; })) {
    throw std::logic_error(fmt::format("page: '{}' is set twice", name));
  }
  values_.emplace_back(std::move(name), std::move(value));
  return *this;
}

PageData& PageData::part(std::string name, std::optional<PageData> shown) {
  std::vector<PageData> entries;
  if (shown) {
    entries.push_back(*std::move(shown));
  }
  return list(std::move(name), std::move(entries));
}

std::string PageData::without_end(std::string text) {
  if (text.ends_with('\n')) {
    text.pop_back();
  }
  return text;
}

std::string render_page(const std::string& text, const PageData& data) {
  check_all_used(text, data);
  mustache::mustache page(without_tag_lines(text));
  if (!page.is_valid()) {
    throw std::logic_error("page: " + page.error_message());
  }
  page.set_custom_escape([](const std::string& value) { return value; });
  const mustache::data filled = filling(data);
  StrictContext context(&filled);
  std::string rendered = page.render(context);
  std::erase(rendered, kLineBegin);
  return rendered;
}

std::string page_text(std::string_view name, const PageData& data) {
  const auto templates = page_templates();
  const auto found =
      std::ranges::find(templates, name, [](const PageTemplate& one) { return stem_of(one.path); });
  if (found == templates.end()) {
    throw std::logic_error(fmt::format("page: the program has no template '{}'", name));
  }
  try {
    return render_page(std::string(found->text), data);
  } catch (const std::logic_error& error) {
    throw std::logic_error(fmt::format("{}: {}", found->path, error.what()));
  }
}

std::string page_json(std::string_view name, const PageData& data) {
  return Json{{"template", name}, {"data", to_json(data)}}.dump(1) + "\n";
}

StoredPage parse_page_json(const std::string& json, const std::filesystem::path& file) {
  try {
    const Json parsed = Json::parse(json);
    return {parsed.at("template").get<std::string>(), from_json(parsed.at("data"))};
  } catch (const nlohmann::json::exception&) {
    throw InputError(
        fmt::format("{}: this is no page's data, a JSON object with 'template' and 'data'", file.string()));
  }
}

void write_page(const std::filesystem::path& folder, const std::string& stem, std::string_view page_template,
                const PageData& data) {
  write_file(folder / (stem + ".md"), page_text(page_template, data));
  write_file(folder / (stem + ".page.json"), page_json(page_template, data));
}

}  // namespace dtof
