# SPDX-License-Identifier: Apache-2.0
"""What scripts/check_documents.py complains about, on small trees, and that it finds nothing in this one."""

import subprocess
import tempfile
import unittest
from pathlib import Path

import check_documents

ROOT = Path(__file__).resolve().parent.parent.parent


class Documents(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name) / "tree"
        self.files: set[str] = set()
        self.write("README.md", "# Read\n\n[index](docs/README.md), [a](docs/a.md#two-words)\n")
        self.write("docs/README.md", "# Index\n\n[a](a.md), [up](../README.md#read), [out](https://example.org/#x)\n")
        self.write("docs/a.md", "# A\n\n## Two words\n\n[here](#two-words), [code](../hdl/thesis), "
                                "![p](../reports/p.svg)\n")
        self.write("hdl/thesis/array.sv", "module array (\n);\nendmodule\n")
        self.write("reports/p.svg", "picture")

    def write(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        self.files.add(name)

    def found(self) -> list[str]:
        return check_documents.problems(self.root, sorted(self.files))

    def block(self, page: str, *modules: str) -> None:
        name = f"{check_documents.BLOCKS}{page}.md"
        self.write(name, "# Blocks\n\n" + "".join(f"## `{module}`\n\ntext\n\n" for module in modules))
        index = self.root / "docs/README.md"
        index.write_text(index.read_text(encoding="utf-8") + f"\n[b](reference/blocks/{page}.md)\n", encoding="utf-8")

    def test_what_resolves(self) -> None:
        self.block("top", "array")
        self.assertEqual(self.found(), [])

    def test_links_that_lead_nowhere(self) -> None:
        self.block("top", "array")
        (self.root / "built.md").write_text("# Not kept by git\n", encoding="utf-8")
        for address, sentence in {"docs/b.md": "does not exist", "docs/a.md#three": "has no such anchor",
                                  "#write": "has no such anchor", "hdl/thesis/array.sv#L3": "has no such anchor",
                                  "built.md": "does not exist", "../other/README.md": "leads out of the tree",
                                  "/etc/passwd": "leads out of the tree", "docs/none": "does not exist"}.items():
            for link in (f"[x]({address})", f"![x]({address})", f"| a |\n|---|\n| [x]({address}) |"):
                self.write("CHANGELOG.md", f"# Changes\n\n{link}\n")
                self.assertEqual(self.found(), [f"CHANGELOG.md: {address} {sentence}"])

    def test_tables_of_reports_are_described(self) -> None:
        self.block("top", "array")
        self.write("reports/a.csv", "mm2,light,mw\n1,day,2\n")
        self.assertEqual(self.found(), ["docs/reference/formats.md: reports/a.csv is not described"])
        self.write("docs/README.md", "# Index\n\n[a](a.md), [b](reference/blocks/top.md), [f](reference/formats.md)\n")
        for columns, sentences in {
                "`mm2`, `light` (day or dusk), `mw`": [],
                "`mm2`, `mw`": ["docs/reference/formats.md: reports/a.csv has the columns mm2, light, mw, not mm2, mw"]}.items():
            self.write("docs/reference/formats.md", f"# F\n\n| file | by | columns |\n|---|---|---|\n| `a.csv` | `make a` | {columns} |\n")
            self.assertEqual(self.found(), sentences)

    def test_code_is_no_link(self) -> None:
        self.block("top", "array")
        self.write("CHANGELOG.md", "# Changes\n\n    [x](none.txt)\n\n`[x](none.txt)`\n\n```\n[x](none.txt)\n```\n")
        self.assertEqual(self.found(), [])

    def test_a_page_that_the_index_lacks(self) -> None:
        self.block("top", "array")
        self.write("docs/user/new.md", "# New\n")
        self.assertEqual(self.found(), ["docs/README.md: docs/user/new.md is not listed"])

    def test_a_page_that_a_comment_names(self) -> None:
        self.block("top", "array")
        self.write("hdl/thesis/array.sv", "// See docs/a.md.\nmodule array (\n);\nendmodule\n")
        self.assertEqual(self.found(), [])
        gone = "docs/" + "gone.md"
        for named in (f"{gone}, Section.", f"Equation ({gone}, Section): a", f"`{gone}`"):
            self.write("hdl/thesis/array.sv", f"// See\n// {named}\nmodule array (\n);\nendmodule\n")
            self.assertEqual(self.found(), [f"hdl/thesis/array.sv:2: {gone} does not exist"])

    def test_every_module_has_one_section(self) -> None:
        self.block("top", "array")
        self.write("hdl/pool/new.sv", "module new_part #(\n    parameter int A = 1\n) (\n);\nendmodule\n")
        self.write("formal/proof.sv", "module proof (\n);\nendmodule\n")
        found, = self.found()
        self.assertIn("hdl/pool/new.sv: no page of", found)
        self.block("engine", "new_part")
        self.assertEqual(self.found(), [])
        self.block("again", "array")
        found, = self.found()
        self.assertIn("array has more than one section", found)
        self.files.remove(f"{check_documents.BLOCKS}again.md")
        self.write("docs/README.md", "[a](a.md) [t](reference/blocks/top.md) [e](reference/blocks/engine.md)\n")
        self.write("README.md", "# Read\n")
        self.write("hdl/pool/new.sv", "module renamed (\n);\nendmodule\n")
        self.assertEqual(len(self.found()), 2)
        self.assertIn("new_part is no module of hdl/", self.found()[1])

    def test_a_section_names_what_the_module_has(self) -> None:
        self.block("top", "array")
        self.write("hdl/thesis/array.sv", "module array #(\n    parameter int WIDTH = 1\n) (\n    input start_i\n);\n"
                                       "endmodule\n")
        page = self.root / f"{check_documents.BLOCKS}top.md"
        text = page.read_text(encoding="utf-8")
        page.write_text(f"{text}`WIDTH`, `start_i`, `X`, IDLE, `hdl/x_i.sv`\n", encoding="utf-8")
        self.assertEqual(self.found(), [])
        page.write_text(f"{text}`DEPTH`, `stop_i`\n", encoding="utf-8")
        self.assertEqual(self.found(), [f"{check_documents.BLOCKS}top.md: {part} of array is not in hdl/thesis/array.sv"
                                        for part in ("DEPTH", "stop_i")])

    def test_this_tree(self) -> None:
        ran = subprocess.run([ROOT / "scripts/check_documents.py"], capture_output=True, text=True)
        self.assertEqual((ran.stderr, ran.returncode), ("", 0))


if __name__ == "__main__":
    unittest.main()
