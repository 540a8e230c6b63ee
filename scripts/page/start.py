# SPDX-License-Identifier: Apache-2.0
"""The start page: what the project is and its three doors, as README.md has them."""

import html
import re
from dataclasses import dataclass

# What README.md says in front of its first picture, and its doors: `**Title.** text`, then commands with what each does.
DOORS = re.compile(r"^## Three doors\n(?P<doors>.*?)(?=^## )", re.DOTALL | re.MULTILINE)
DOOR = re.compile(r"^\*\*(?P<title>[^*]+)\.\*\* (?P<text>.*?)(?=^\*\*|\Z)", re.DOTALL | re.MULTILINE)
COMMAND = re.compile(r"^    (?P<command>\S.*?)\s+# (?P<does>.*)$")
# What is behind each door, in a sentence of its card.
SAYS = {
    "Try it": "Read a scene out on your computer, from the command line or in NumPy.",
    "Bring your sensor": "Describe your laser, SPADs and TDC in a file, and see which read-out suits them.",
    "Put it on a chip": "Take the RTL, its registers, driver and constraints.",
}


@dataclass(frozen=True)
class Door:
    title: str
    text: str  # Markdown
    commands: tuple[tuple[str, str], ...]  # command, what it does

    @property
    def anchor(self) -> str:
        return self.title.lower().replace(" ", "-")


def about(readme: str) -> str:
    """The paragraphs between title and first picture, without references to later text."""
    body = readme.partition("\n")[2]
    return re.split(r"^(?:!\[|## )", body, maxsplit=1, flags=re.MULTILINE)[0].strip().replace(" [1]", "")


def doors(readme: str) -> list[Door]:
    section = DOORS.search(readme)
    found = []
    for match in DOOR.finditer(section["doors"]) if section else ():
        lines = match["text"].splitlines()
        commands = [parts for line in lines if (parts := COMMAND.match(line))]
        text = match["text"].partition("\n\n")[0].strip()  # its paragraph; the commands stand below
        found.append(Door(match["title"], text, tuple((parts["command"], parts["does"]) for parts in commands)))
    return found


def cards(found: list[Door]) -> str:
    return '<div class="doors">' + "".join(
        f'<a class="door" href="#{door.anchor}"><strong>{html.escape(door.title)}</strong>{html.escape(SAYS.get(door.title, ""))}</a>'
        for door in found) + "</div>"


def words(command: str) -> str:
    """A command whose lines end between words, and not behind the hyphens of an option."""
    return " ".join(f'<span class="word">{html.escape(word)}</span>' for word in command.split(" "))


def commands_table(door: Door) -> str:
    if not door.commands:
        return ""
    rows = "".join(f"<tr><td><code>{words(command)}</code></td><td>{html.escape(does)}</td></tr>" for command, does in door.commands)
    return ('<div class="scroll" tabindex="0"><table class="commands"><thead><tr><th>command</th><th>what it does</th></tr></thead>'
            f"<tbody>{rows}</tbody></table></div>")
