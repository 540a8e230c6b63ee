# SPDX-License-Identifier: Apache-2.0
"""Writes the pages: the first one, one of each report, one of each document that they link to."""

import html
import shutil
from pathlib import Path
from urllib.parse import unquote, urlsplit

from figures import staleness
from figures.reports import LIST, inputs, load
from figures.source_tree import SourceTree

from . import figures, render
from .commands import Command, commands
from .links import problems
from .sections import ALL, FRAME, LISTED, SHOWN, Report, chosen

STYLE = (Path(__file__).resolve().parent / "style.css").read_text(encoding="utf-8")
NAME = "dtof-readout"
# Copied beside the pages where a report links to them; any other file is named only.
COPIED = (".csv", ".png", ".svg")


class Site:
    def __init__(self, root: Path, out: Path) -> None:
        self.root, self.out = root.resolve(), out
        self.commands: dict[str, Command] = commands(self.root)
        self.sources = {report.name: chosen(report, self.root) for report in ALL}
        self.reports = {}  # Markdown file: report
        for report in ALL:
            self.reports[self.root / "reports" / report.committed] = report
            if report.built:
                self.reports[self.root / "build" / report.built] = report
        self.documents: dict[Path, str] = {}  # Markdown file: page
        self.waiting: list[Path] = []
        self.marks: dict[str, str] = self.stale_pages()

    def stale_pages(self) -> dict[str, str]:
        """By report, the line that says that it was measured on other inputs than those that lie here."""
        if not (self.root / LIST).is_file():
            return {}
        listed = load(self.root)
        tree = SourceTree(self.root)
        found = {}
        for report in ALL:
            entry = next((one for one in listed.values() if report.committed in one.pages), None)
            source = self.sources[report.name]
            if entry is None or source is None:
                continue
            built = source.is_relative_to(self.root / "build")
            known = staleness.begun(self.root, entry) if built else staleness.measured(self.root).get(entry.name)
            stale = staleness.compared(entry, known, inputs(entry, tree))
            if stale:
                found[report.name] = stale.line.removeprefix("> ")
        return found

    def text(self, report: Report) -> str:
        """The report with the line that says whether it is stale, which what lies in build/ does not have."""
        source = self.sources[report.name]
        assert source is not None
        text = staleness.without_mark(source.read_text(encoding="utf-8"))
        return f"> {self.marks[report.name]}\n\n{text}" if report.name in self.marks else text

    # ---- Links ------------------------------------------------------------------------------------------

    def copied(self, source: Path, page: str) -> str:
        """Address of a copy of the file. Those of a report lie together, whether from build/ or reports/."""
        place = Path("files") / source.relative_to(self.root)
        (self.out / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, self.out / place)
        return render.relative(str(place), page)

    def document(self, path: Path) -> str:
        if path not in self.documents:
            self.documents[path] = f"documents/{path.relative_to(self.root).with_suffix('.html')}"
            self.waiting.append(path)
        return self.documents[path]

    def linker(self, source: Path, page: str, prefix: str = ""):
        """Where an address in the Markdown file `source` leads on `page`."""
        report = self.reports.get(source)
        folders = [source.parent] + ([(self.root / "reports" / report.committed).parent] if report else [])
        whole = self.whole_page(report) if report else page

        def link(address: str) -> str | None:
            parts = urlsplit(address)
            if parts.scheme:
                return address if parts.scheme in ("http", "https") else None
            fragment = f"#{parts.fragment}" if parts.fragment else ""
            if not parts.path:  # a heading of the whole report, of which this page may be an excerpt
                return fragment if page == whole else render.relative(whole, page) + fragment
            for folder in folders:
                target = (folder / unquote(parts.path)).resolve()
                if target in self.reports:
                    named = self.reports[target]
                    return render.relative(self.whole_page(named), page) + fragment if self.sources[named.name] else None
                if not target.is_file() or not target.is_relative_to(self.root):
                    continue
                if target.suffix == ".md":
                    return render.relative(self.document(target), page) + fragment
                return self.copied(target, page) if target.suffix in COPIED else None
            return None

        return link

    @staticmethod
    def whole_page(report: Report) -> str:
        return f"reports/{report.name}.html"

    # ---- Parts ------------------------------------------------------------------------------------------

    def made_by(self, report: Report, page: str) -> str:
        source = self.sources[report.name]
        index = render.relative("index.html", page)
        command = f'<a href="{index}#make-{report.target}"><code>make {report.target}</code></a>'
        if source is None:
            return f'<p class="missing">Not made yet: {command} makes it.</p>'
        return (f'<p class="made">Made by {command}; shown from <code>{html.escape(str(source.relative_to(self.root)))}'
                "</code>.</p>")

    def pictures(self, report: Report, page: str) -> str:
        """Those that the report's text does not name."""
        source = self.sources[report.name]
        shown = []
        for name in report.pictures:
            for folder in (source.parent, (self.root / "reports" / report.committed).parent):
                if (folder / name).is_file():
                    address = html.escape(self.copied(folder / name, page))
                    shown.append(f'<a class="picture" href="{address}"><img src="{address}" alt="{html.escape(name)}" '
                                 'loading="lazy"></a>')
                    break
        if len(shown) < len(report.pictures):
            shown.append(f"<p>{len(report.pictures) - len(shown)} of {len(report.pictures)} pictures are shown after "
                         f"<code>make {report.target}</code> has run here.</p>")
        return "\n".join(shown)

    def shown(self, report: Report) -> str:
        """A section of the first page."""
        source = self.sources[report.name]
        parts = [f'<section id="{report.name}"><h2>{html.escape(report.title)}</h2>', self.made_by(report, "index.html")]
        if source is not None:
            text = render.excerpt(self.text(report), report.excerpt or ())
            parts.append(render.to_html(text, self.linker(source, "index.html"), 1, f"{report.name}-"))
            parts.append(f'<p><a href="{self.whole_page(report)}">The whole report</a></p>')
        return "\n".join(parts) + "\n</section>"

    def frame(self) -> str:
        """The main job: figures of every read-out, then its maps."""
        source = self.sources[FRAME.name]
        parts = [f'<section id="{FRAME.name}"><h2>{FRAME.title}</h2>', self.made_by(FRAME, "index.html")]
        if source is None:
            return "\n".join(parts) + "\n</section>"
        text = staleness.without_mark(source.read_text(encoding="utf-8"))
        if FRAME.name in self.marks:
            parts.append(f"<blockquote><p>{html.escape(self.marks[FRAME.name])}</p></blockquote>")
        parts.append(f"<p>{html.escape(text.splitlines()[0])}</p>")
        found = figures.figures(self.root, source.parent)
        head = ("read-out", "off by > 3 %", "> 10 %", "rmse, mm", "mm2", "mW by day", "bits a pixel")
        cells = "".join(f"<th>{name}</th>" for name in head)
        parts.append(f'<div class="scroll" tabindex="0"><table class="figures"><thead><tr>{cells}</tr></thead><tbody>')
        for one in found:
            values = (one.above_3, one.above_10, one.rmse_mm, one.mm2, one.mw, one.bits)
            parts.append(f"<tr><th>{html.escape(one.title)}</th>" + "".join(f"<td>{html.escape(value)}</td>"
                                                                            for value in values) + "</tr>")
        parts.append('</tbody></table></div>\n<p>Accuracy: this frame, after each read-out\'s look-up table. Area and memory: <a '
                     'href="#area">the array</a>. Power: <a href="#power">the array</a> while acquisitions of the room at 50 klux '
                     "stream in (day), not of this frame.</p>")
        maps = [self.card(one, source.parent) for one in found]
        if all(maps):
            parts += ['<div class="cards">', *maps, "</div>"]
        else:
            overview = source.parent / "overview.png"
            if overview.is_file():
                address = self.copied(overview, "index.html")
                parts.append(f'<a class="picture" href="{address}"><img src="{address}" alt="Depth maps"></a>')
            parts.append('<p class="missing">Depth and error map of each read-out: <a href="#make-sim"><code>make sim'
                         "</code></a> draws them.</p>")
        parts.append(f'<p><a href="{self.whole_page(FRAME)}">The whole report</a></p>')
        return "\n".join(parts) + "\n</section>"

    def card(self, one: figures.ReadoutFigures, folder: Path) -> str:
        pictures = []
        for kind in ("depth", "error"):
            path = folder / f"{one.name}_{kind}.png"
            if not path.is_file():
                return ""
            address = html.escape(self.copied(path, "index.html"))
            pictures.append(f'<a href="{address}"><img src="{address}" alt="{kind} map of {html.escape(one.title)}" '
                            'loading="lazy"></a>')
        return (f'<figure><figcaption><strong>{html.escape(one.title)}</strong> {one.above_3} off by more than 3 %, rmse '
                f"{one.rmse_mm} mm; {one.mm2} mm2, {one.mw} mW, {one.bits} bits a pixel</figcaption>"
                f'<div class="maps">{"".join(pictures)}</div></figure>')

    def listed(self) -> str:
        lines = ['<section id="more"><h2>More reports</h2>', '<div class="scroll" tabindex="0"><table><thead><tr>'
                 "<th>report</th><th>what it shows</th><th>command</th></tr></thead><tbody>"]
        for report in LISTED:
            title = html.escape(report.title)
            if self.sources[report.name]:
                title = f'<a href="{self.whole_page(report)}">{title}</a>'
            missing = "" if self.sources[report.name] else " <em>Not made yet.</em>"
            if report.name in self.marks:
                missing = f" <em>{html.escape(self.marks[report.name].split('. `')[0])}.</em>"
            lines.append(f"<tr><td>{title}</td><td>{render.to_html(report.says, lambda _: None)[3:-4]}{missing}</td>"
                         f'<td><a href="#make-{report.target}"><code>make {report.target}</code></a></td></tr>')
        return "\n".join(lines) + "</tbody></table></div></section>"

    def commands_table(self) -> str:
        lines = ['<section id="commands"><h2>Commands</h2>', "<p>Run in the project's folder; each says more at the head "
                 'of its makefile.</p>', '<div class="scroll" tabindex="0"><table><thead><tr><th>command</th><th>what it '
                 "does</th><th>where</th></tr></thead><tbody>"]
        for target in sorted(self.commands):
            command = self.commands[target]
            lines.append(f'<tr id="make-{target}"><td><code>make {target}</code></td><td>{html.escape(command.says)}</td>'
                         f"<td><code>{html.escape(command.makefile)}</code></td></tr>")
        return "\n".join(lines) + "</tbody></table></div></section>"

    # ---- Pages ------------------------------------------------------------------------------------------

    def write_page(self, page: str, title: str, body: str) -> None:
        index = render.relative("index.html", page)
        home = "" if page == "index.html" else f'<p><a href="{index}">{NAME}: all results</a></p>\n'
        path = self.out / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f'<meta name="color-scheme" content="light dark">\n'
            f"<title>{html.escape(title)}</title>\n<style>\n{STYLE}</style>\n"
            f"</head>\n<body>\n<main>\n{home}{body}\n</main>\n</body>\n</html>\n", encoding="utf-8")

    def write_index(self) -> None:
        sections = [(FRAME.name, FRAME.title), *((report.name, report.title) for report in SHOWN),
                    ("more", "More reports"), ("commands", "Commands")]
        menu = "".join(f'<li><a href="#{name}">{html.escape(title)}</a></li>' for name, title in sections)
        readme = self.root / "README.md"
        about = ""
        if readme.is_file():
            about = f' <a href="{self.document(readme)}">What it is, and how to use it</a>.'
        body = [f"<h1>{NAME}</h1>", "<p>On-chip read-out for large SPAD arrays: what the commands of this tree found. Every "
                f"section names the command that made it.{about}</p>", f"<nav><ul>{menu}</ul></nav>", self.frame(),
                *(self.shown(report) for report in SHOWN), self.listed(), self.commands_table()]
        self.write_page("index.html", f"{NAME}: results", "\n".join(body))

    def write_report(self, report: Report) -> None:
        source = self.sources[report.name]
        if source is None:
            return
        page = self.whole_page(report)
        text = self.text(report)
        heading = render.title(text, "")
        body = "" if heading else f"<h1>{html.escape(report.title)}</h1>\n"
        body += self.made_by(report, page) + "\n" + render.to_html(text, self.linker(source, page))
        self.write_page(page, heading or report.title, body + "\n" + self.pictures(report, page))

    def write(self) -> list[str]:
        """Writes all pages; what is wrong with their links."""
        if self.out.is_dir() and any(self.out.iterdir()) and not (self.out / "index.html").is_file():
            return [f"{self.out}: has other files than these pages, which replace its content"]
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir(parents=True)
        self.write_index()
        for report in ALL:
            self.write_report(report)
        while self.waiting:
            path = self.waiting.pop()
            page = self.documents[path]
            text = path.read_text(encoding="utf-8")
            self.write_page(page, render.title(text, path.stem), render.to_html(text, self.linker(path, page)))
        return problems(self.out)
