// SPDX-License-Identifier: Apache-2.0
#include "page/page.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>
#include <stdexcept>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "page/templates.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

const char* const kTemplate =
    "{{! SPDX }}\n# Cells\n\n{{cells}} cells of `{{sensor}}`.\n\n{{#findings}}\n* {{name}}: {{share}} % < 3 "
    "& more\n{{/findings}}\n"
    "{{^findings}}\nNo entry.\n{{/findings}}\n\n{{table}}\n{{#full}}\n\n## Full\n{{/full}}\n";

PageData example(std::vector<PageData> findings, bool full) {
  Table table({"read-out", "mm2"});
  table.add({"ezPointer", "1.32"});
  PageData data;
  data.set("cells", "{}", 144).set("sensor", "{}", "thesis").list("findings", std::move(findings));
  data.set("table", table).flag("full", full);
  return data;
}

PageData finding(const char* name, double share) {
  PageData data;
  data.set("name", "{}", name).set("share", "{:.2f}", share);
  return data;
}

TEST(Page, ATemplateTurnsDataIntoAPage) {
  EXPECT_EQ(render_page(kTemplate, example({finding("lean", 85.094), finding("a", 1.0)}, true)),
            "# Cells\n\n144 cells of `thesis`.\n\n* lean: 85.09 % < 3 & more\n* a: 1.00 % < 3 & more\n\n"
            "| read-out  |  mm2 |\n|-----------|-----:|\n| ezPointer | 1.32 |\n\n## Full\n");
  EXPECT_EQ(render_page(kTemplate, example({}, false)),
            "# Cells\n\n144 cells of `thesis`.\n\nNo entry.\n\n| read-out  |  mm2 |\n|-----------|-----:|\n| "
            "ezPointer | 1.32 |\n");
}

TEST(Page, ANameThatOnlyOneSideHasIsAnError) {
  EXPECT_THAT([] { render_page("{{cells}} of {{cels}}\n", PageData().set("cells", "{}", 1)); },
              ThrowsMessage<std::logic_error>(HasSubstr("the data has no 'cels'")));
  EXPECT_THAT([] { render_page("{{#none}}x{{/none}}\n", PageData()); },
              ThrowsMessage<std::logic_error>(HasSubstr("the data has no 'none'")));
  EXPECT_THAT([] { render_page("Cells.\n", PageData().set("cells", "{}", 1)); },
              ThrowsMessage<std::logic_error>(HasSubstr("the template does not use 'cells'")));
  EXPECT_THAT([] { render_page("{{#rows}}.{{/rows}}\n", PageData().list("rows", {finding("a", 1.0)})); },
              ThrowsMessage<std::logic_error>(HasSubstr("the template does not use 'name'")));
  EXPECT_THAT([] { PageData().set("a", "{}", 1).flag("a", true); },
              ThrowsMessage<std::logic_error>(HasSubstr("'a' is set twice")));
  EXPECT_THAT([] { render_page("{{#a}}x\n", PageData().flag("a", true)); },
              ThrowsMessage<std::logic_error>(StartsWith("page: ")));
  EXPECT_THAT([] { page_text("no_such_page", {}); },
              ThrowsMessage<std::logic_error>(HasSubstr("the program has no template 'no_such_page'")));
}

TEST(Page, StoredDataIsTheSameData) {
  const PageData data = example({finding("\"lean\"\n", 0.5)}, true);
  const StoredPage stored = parse_page_json(page_json("cells", data), "cells.page.json");
  EXPECT_EQ(stored.page_template, "cells");
  EXPECT_EQ(stored.data, data);
  for (const char* const wrong : {"", "{}", "[]", "{\"template\": \"a\", \"data\": {\"b\": 1}}"}) {
    EXPECT_THAT([&] { parse_page_json(wrong, "a/b.page.json"); },
                ThrowsMessage<InputError>(StartsWith("a/b.page.json: this is no page's data")));
  }
}

TEST(Page, EachTemplateHasItsOwnNameAndALicence) {
  std::set<std::string> stems;
  for (const PageTemplate& one : page_templates()) {
    EXPECT_TRUE(stems.insert(std::filesystem::path(one.path).stem()).second) << one.path;
    EXPECT_THAT(std::string(one.text), StartsWith("{{! SPDX-License-Identifier: Apache-2.0 }}\n#"))
        << one.path;
  }
}

}  // namespace
}  // namespace dtof
