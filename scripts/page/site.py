# SPDX-License-Identifier: Apache-2.0
"""Writes the pages: start page, results, a page per report and document, and the search index."""

import html
import re
import shutil
from pathlib import Path
from urllib.parse import unquote, urlsplit

from figures import staleness
from figures.reports import LIST, inputs, load
from figures.source_tree import SourceTree

from . import figures, layout, plots, render, start
from .commands import Command, commands
from .layout import NAME
from .library import Library
from .links import problems
from .search import Index
from .sections import ALL, FRAME, LISTED, SHOWN, Report, chosen

HERE = Path(__file__).resolve().parent
ASSETS = ("style.css", "page.js")  # beside the pages
RESULTS, PLOTS, COMMANDS = "results.html", "plots.html", "commands.html"
PLAYGROUND = "playground.html"
LIBRARY, LICENCE = "chart.js", "chart.js.LICENSE.md"
GLOSSARY, DOCUMENTS = "docs/reference/glossary.md", "docs/README.md"
WORD_ROW = re.compile(r"<tr>\n<td>(?P<word>[^<]*)</td>")
# Copied beside the pages where a page links to them; any other file is named only.
COPIED = (".csv", ".png", ".svg", ".ipynb")


def stale_lines(plot: plots.Plot) -> str:
    return f'<blockquote class="stale">{"".join(f"<p>{html.escape(line)}</p>" for line in plot.stale)}</blockquote>' if plot.stale else ""


class Site:
    def __init__(self, root: Path, out: Path, library: Library = Library(None, None, "this page was made without it")) -> None:
        self.root, self.out, self.library = root.resolve(), out, library
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
        self.plots, self.titles = plots.collect(self.root)
        self.index = Index()
        self.entries = [layout.Entry("Start", "index.html"), layout.Entry("Results", RESULTS, "reports/"),
                        layout.Entry("Plots", PLOTS)]
        for title, name, folder in (("Documents", DOCUMENTS, "documents/"), ("Glossary", GLOSSARY, "")):
            if (self.root / name).is_file():
                self.entries.append(layout.Entry(title, self.document(self.root / name), folder))
        self.entries.append(layout.Entry("Commands", COMMANDS))
        self.playground = self.root / "build/playground/index.html"  # of make playground, one file
        if self.playground.is_file():
            self.entries.insert(1, layout.Entry("Playground", PLAYGROUND))

    def stale_pages(self) -> dict[str, str]:
        """Mark of each stale report, by report."""
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
        """Text of a report with its stale mark, which files in build/ lack."""
        source = self.sources[report.name]
        assert source is not None
        text = staleness.without_mark(source.read_text(encoding="utf-8"))
        return f"> {self.marks[report.name]}\n\n{text}" if report.name in self.marks else text

    # ---- Links ------------------------------------------------------------------------------------------

    def copied(self, source: Path, page: str) -> str:
        """Copies the file; returns its address from `page`. Files of a report are copied to one folder, whether from build/ or reports/."""
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
        """Function that maps an address in the Markdown file `source` to one on `page`."""
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

    def command(self, target: str, page: str) -> str:
        return f'<a href="{render.relative(COMMANDS, page)}#make-{target}"><code>make {target}</code></a>'

    def mark(self, report: Report) -> str:
        """Stale mark of a report; empty if it is fresh."""
        if report.name not in self.marks:
            return ""
        return f'<blockquote class="stale">{render.to_html(self.marks[report.name], lambda _: None)}</blockquote>'

    def made_by(self, report: Report, page: str) -> str:
        source = self.sources[report.name]
        command = self.command(report.target, page)
        if source is None:
            return f'<p class="missing">Not made yet: {command} makes it.</p>'
        return (f'<p class="made">Made by {command}; shown from <code>{html.escape(str(source.relative_to(self.root)))}'
                "</code>.</p>")

    def pictures(self, report: Report, page: str) -> str:
        """Pictures of the report that its text does not show."""
        source = self.sources[report.name]
        assert source is not None
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
        """Section of a report on the page of results."""
        source = self.sources[report.name]
        parts = [f'<section id="{report.name}"><h2>{html.escape(report.title)}</h2>', self.made_by(report, RESULTS)]
        if source is not None:
            text = render.excerpt(self.text(report), report.excerpt or ())
            parts.append(render.to_html(text, self.linker(source, RESULTS), 1, f"{report.name}-"))
            parts.append(f'<p><a href="{self.whole_page(report)}">The whole report</a></p>')
        return "\n".join(parts) + "\n</section>"

    def frame_figures(self, page: str) -> str:
        """Table of the main job's figures."""
        source = self.sources[FRAME.name]
        if source is None:
            return self.made_by(FRAME, page)
        text = staleness.without_mark(source.read_text(encoding="utf-8"))
        parts = [self.made_by(FRAME, page), self.mark(FRAME), f"<p>{html.escape(text.splitlines()[0])}</p>"]
        head = ("read-out", "off by > 3 %", "> 10 %", "rmse, mm", "mm2", "mW by day", "bits a pixel")
        cells = "".join(f"<th>{name}</th>" for name in head)
        parts.append(f'<div class="scroll" tabindex="0"><table class="figures"><thead><tr>{cells}</tr></thead><tbody>')
        for one in figures.figures(self.root, source.parent):
            values = (one.above_3, one.above_10, one.rmse_mm, one.mm2, one.mw, one.bits)
            parts.append(f"<tr><th>{html.escape(one.title)}</th>" + "".join(f"<td>{html.escape(value)}</td>"
                                                                            for value in values) + "</tr>")
        results = render.relative(RESULTS, page) if page != RESULTS else ""
        parts.append('</tbody></table></div>\n<p>Accuracy: this frame, with distances corrected by each read-out\'s look-up table. Area and memory: <a '
                     f'href="{results}#area">the array</a>. Power: <a href="{results}#power">the array</a> while acquisitions of the '
                     "room at 50 klux stream in (day), which is another light than this frame's.</p>")
        return "\n".join(parts)

    def frame(self) -> str:
        """Section of the main job: figures of every read-out, then its maps."""
        source = self.sources[FRAME.name]
        parts = [f'<section id="{FRAME.name}"><h2>{FRAME.title}</h2>', self.frame_figures(RESULTS)]
        if source is None:
            return "\n".join(parts) + "\n</section>"
        maps = [self.card(one, source.parent) for one in figures.figures(self.root, source.parent)]
        if all(maps):
            parts += ['<div class="cards">', *maps, "</div>"]
        else:
            overview = source.parent / "overview.png"
            if overview.is_file():
                address = self.copied(overview, RESULTS)
                parts.append(f'<a class="picture" href="{address}"><img src="{address}" alt="Depth maps"></a>')
            parts.append(f'<p class="missing">Depth and error map of each read-out: {self.command("sim", RESULTS)} draws them.</p>')
        parts.append(f'<p><a href="{self.whole_page(FRAME)}">The whole report</a></p>')
        return "\n".join(parts) + "\n</section>"

    def card(self, one: figures.ReadoutFigures, folder: Path) -> str:
        pictures = []
        for kind in ("depth", "error"):
            path = folder / f"{one.name}_{kind}.png"
            if not path.is_file():
                return ""
            address = html.escape(self.copied(path, RESULTS))
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
                         f"<td>{self.command(report.target, RESULTS)}</td></tr>")
        return "\n".join(lines) + "</tbody></table></div></section>"

    def commands_table(self) -> str:
        lines = ["<h1>Commands</h1>", "<p>Run the commands in the project's folder. The comment at the head "
                 'of each makefile says more.</p>', '<div class="scroll" tabindex="0"><table class="commands"><thead><tr><th>command</th><th>what it '
                 "does</th><th>where</th></tr></thead><tbody>"]
        for target in sorted(self.commands):
            command = self.commands[target]
            lines.append(f'<tr id="make-{target}"><td><code>make {target}</code></td><td>{html.escape(command.says)}</td>'
                         f"<td><code>{html.escape(command.makefile)}</code></td></tr>")
        return "\n".join(lines) + "</tbody></table></div>"

    # ---- Pages ------------------------------------------------------------------------------------------

    def write_page(self, page: str, title: str, body: str, searched: bool = True, scripts: tuple[str, ...] = ()) -> None:
        """Writes a page. `searched`: include its text in the search index, which should have each text once."""
        path = self.out / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(layout.whole(page, title, body, self.entries, scripts), encoding="utf-8")
        if searched:
            self.index.add(page, title, body)

    def write_start(self) -> None:
        """Writes the start page: what the project is, three doors, results."""
        page = "index.html"
        readme = self.root / "README.md"
        text = readme.read_text(encoding="utf-8") if readme.is_file() else ""
        link = self.linker(readme, page)
        found = start.doors(text)
        body = [f"<h1>{NAME}</h1>", f'<div class="lead">{render.to_html(start.about(text), link)}</div>', start.cards(found),
                self.first_picture(page),
                '<section id="figures"><h2>One scene through every read-out</h2>', self.frame_figures(page),
                f'<p><a href="{RESULTS}">All results</a>, each with the command that made it.</p></section>']
        for door in found:
            browser = f'<p><a href="{PLAYGROUND}">In the browser</a>: choose a scene, its light and the read-outs; nothing to install.</p>' \
                if door.title == "Try it" and self.playground.is_file() else ""
            body.append(f'<section id="{door.anchor}"><h2>{html.escape(door.title)}</h2>{browser}{render.to_html(door.text, link)}'
                        f"{start.commands_table(door)}</section>")
        if text:
            body.append(f'<p>More: <a href="{self.document(readme)}">README</a>.</p>')
        self.write_page(page, NAME, "\n".join(body))

    def first_picture(self, page: str) -> str:
        """Picture of area against accuracy, with a link to the plots."""
        plot = self.plots[0]
        picture = self.root / "reports" / plot.picture
        if not picture.is_file():
            return ""
        return (f'<section id="accuracy"><h2>{html.escape(plot.title)}</h2>{stale_lines(plot)}<a class="picture" href="{PLOTS}">'
                f'<img src="{html.escape(self.copied(picture, page))}" alt="{html.escape(plot.title)}"></a>'
                f'<p><a href="{PLOTS}">Plots</a> show each mark\'s figure and command; choose read-outs and light.</p></section>')

    def write_results(self) -> None:
        body = ["<h1>Results</h1>", "<p>Results of this project's commands. Every section names the command that made it.</p>",
                self.frame(), *(self.shown(report) for report in SHOWN), self.listed()]
        self.write_page(RESULTS, "Results", "\n".join(body), searched=False)
        self.write_page(COMMANDS, "Commands", self.commands_table())

    def write_plots(self) -> None:
        """Writes the live plots; without their library, pictures of the same figures."""
        live = self.library.script is not None
        body = ["<h1>Plots</h1>"]
        if live:
            body += ["<p>Move the mouse over a mark, touch it, or go from mark to mark with the arrow keys, to see its figure and the command that made it. "
                     "The list has the marks of plots with lines; in plots without lines, hollow marks are at 50 klux.</p>",
                     '<div class="filtered"><form id="filters" hidden></form><div>']
        else:
            body.append(f'<p class="missing">The plots of this page are pictures, because the plotting library ({LIBRARY}) is missing: '
                        f"{html.escape(self.library.why_not)}.</p>")
        body += [self.plot(plot, live) for plot in self.plots]
        scripts: tuple[str, ...] = ()
        if self.library.script and self.library.licence:
            shutil.copyfile(self.library.script, self.out / LIBRARY)
            shutil.copyfile(self.library.licence, self.out / LICENCE)
            shutil.copyfile(HERE / "plots.js", self.out / "plots.js")
            (self.out / plots.FILE).write_text(plots.as_script(self.plots, self.titles), encoding="utf-8")
            body.append(f'</div></div><p class="made">Drawn by Chart.js (<a href="{LICENCE}">licence</a>).</p>')
            scripts = (LIBRARY, plots.FILE, "plots.js")
        self.write_page(PLOTS, "Plots", "\n".join(body), scripts=scripts)

    def plot(self, plot: plots.Plot, live: bool) -> str:
        report = next((one for one in ALL if one.committed == f"{plot.report}.md"), None)
        parts = [f'<section id="{plot.name}"><h2>{html.escape(plot.title)}</h2>']
        if report:
            whole = f', <a href="{self.whole_page(report)}">report</a>' if self.sources[report.name] else ""
            measured = f"; commit <code>{plot.commit}</code>, inputs <code>{plot.inputs}</code>" if plot.commit else ""
            parts.append(f'<p class="made">Made by {self.command(report.target, PLOTS)}{whole}, from <code>{plot.source}</code>{measured}.</p>')
        parts += [stale_lines(plot), f"<p>{html.escape(plot.says)}</p>"]
        picture = self.root / "reports" / plot.picture
        if not plot.rows:
            parts.append('<p class="missing">Not measured yet.</p>')
        elif live:
            parts.append('<div class="choices"></div><p class="none" hidden>No read-out or no light is chosen that has figures here.</p>'
                         f'<div class="wide"><div class="live {plot.kind}" hidden><canvas></canvas><div class="tip" role="status" hidden></div></div></div>')
        elif plot.picture and picture.is_file():
            address = html.escape(self.copied(picture, PLOTS))
            parts.append(f'<a class="picture" href="{address}"><img src="{address}" alt="{html.escape(plot.title)}"></a>')
        else:
            parts.append('<p class="missing">The report has these figures as tables.</p>')
        return "\n".join(parts) + "\n</section>"

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
        """Writes all pages; returns the faults of their links."""
        if self.out.is_dir() and any(self.out.iterdir()) and not (self.out / "index.html").is_file():
            return [f"{self.out}: has other files than these pages, which replace its content"]
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir(parents=True)
        for name in ASSETS:
            shutil.copyfile(HERE / name, self.out / name)
        if self.playground.is_file():
            self.write_playground()
        self.write_start()
        self.write_results()
        self.write_plots()
        for report in ALL:
            self.write_report(report)
        for path in sorted(self.root.glob("docs/*/**/*.md")):
            self.document(path)
        while self.waiting:
            self.write_document(self.waiting.pop())
        self.index.write(self.out)
        return problems(self.out)

    def write_playground(self) -> None:
        """Copies the playground as it was built, with links to the other pages."""
        text = self.playground.read_text(encoding="utf-8")
        self.index.add(PLAYGROUND, "Playground", text)
        links = " ".join(f'<a href="{entry.page}"{" aria-current=page" if entry.page == PLAYGROUND else ""}>{html.escape(entry.title)}</a>'
                         for entry in self.entries)
        text = text.replace("<main>", f'<main>\n<nav class="pages" aria-label="Pages"><strong>{NAME}</strong> {links}</nav>', 1)
        (self.out / PLAYGROUND).write_text(text, encoding="utf-8")

    def write_document(self, path: Path) -> None:
        page = self.documents[path]
        text = path.read_text(encoding="utf-8")
        body = render.to_html(text, self.linker(path, page))
        name = path.relative_to(self.root).as_posix()
        if name == GLOSSARY:  # each word can be linked to, and is found
            taken: set[str] = set()
            body = WORD_ROW.sub(lambda row: f'<tr id="word-{render.unique_slug(row["word"], taken)}">\n<td>{row["word"]}</td>', body)
        title = render.title(text, path.stem)
        if name.startswith("docs/") and name != DOCUMENTS and (self.root / DOCUMENTS).is_file():
            above = render.relative(self.document(self.root / DOCUMENTS), page)
            body = f'<p class="where"><a href="{above}">Documents</a> / {html.escape(Path(name).parent.relative_to("docs").as_posix())}</p>\n' + body
        self.write_page(page, title, body)
