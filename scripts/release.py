#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a release consists of, and its metadata.

`archive [--out FOLDER] [--commit COMMIT]`  writes the source archive of a commit, its notes (the version's part of CHANGELOG.md) and SHA256SUMS.
                  The same commit gives the same bytes. Nothing that was not committed is in the archive.
`ready`           says what still speaks against a tag, one line each, and fails if something does

The version is that of CMakeLists.txt. scripts/generate.py writes it into CITATION.cff and dtof.core, and .zenodo.json from CITATION.cff.
"""

import argparse
import gzip
import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

import yaml

import file_lists
from dtof_synth import program
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parent.parent
CITATION, ZENODO, CHANGELOG = "CITATION.cff", ".zenodo.json", "CHANGELOG.md"
NAME = "dtof-readout"
SUMS, NOTES = "SHA256SUMS", "NOTES.md"


def citation(text: str, version: str) -> str:
    """CITATION.cff with this version."""
    text, count = re.subn(r"^version: .*$", f"version: {version}", text, flags=re.MULTILINE)
    if count != 1:
        raise FlowError(f"{CITATION} has {count} lines 'version:', not 1")
    return text


def zenodo(cited: str) -> str:
    """.zenodo.json: what an archive that gives DOIs asks for, from CITATION.cff."""
    table = yaml.safe_load(cited)
    return json.dumps({
        "title": f"{table['title']}: {table['abstract'].rstrip('.')}",
        "description": table["abstract"],
        "version": table["version"],
        "upload_type": "software",
        "access_right": "open",
        "license": table["license"],
        "creators": [{"name": author["name"]} for author in table["authors"]],
        "keywords": table["keywords"],
        "references": [f"{work['title']} ({work['thesis-type']}, {work['institution']['name']})" for work in table["references"]],
    }, indent=2, ensure_ascii=False) + "\n"


def notes(text: str, version: str) -> str:
    """The part of the changelog about this version; FlowError if another version is the first one in it."""
    parts = re.split(r"^## ", text, flags=re.MULTILINE)
    if len(parts) < 2 or not re.match(rf"{re.escape(version)}\b(?!\.)", parts[1]):
        raise FlowError(f"{CHANGELOG} does not begin with version {version}")
    return f"## {parts[1].rstrip()}\n"


def git(*arguments: str) -> bytes:
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=False)
    if done.returncode:
        raise FlowError(f"git {arguments[0]}: {done.stderr.decode(errors='replace').strip()}")
    return done.stdout


def committed(commit: str, name: str) -> str:
    return git("show", f"{commit}:{name}").decode("utf-8")


def archive(out: Path, commit: str) -> list[Path]:
    version = file_lists.version_in(committed(commit, "CMakeLists.txt"))
    name = f"{NAME}-{version}"
    says = notes(committed(commit, CHANGELOG), version)
    packed = gzip.compress(git("archive", "--format=tar", f"--prefix={name}/", commit), mtime=0)
    out.mkdir(parents=True, exist_ok=True)
    files = {f"{name}.tar.gz": packed, NOTES: says.encode("utf-8")}
    files[SUMS] = "".join(f"{hashlib.sha256(content).hexdigest()}  {file}\n" for file, content in files.items()).encode("ascii")
    for file, content in files.items():
        (out / file).write_bytes(content)
    return [out / file for file in files]


def obstacles() -> list[str]:
    """What speaks against a tag of what lies here."""
    version = file_lists.version()
    found = []
    if git("tag", "--list", f"v{version}"):
        found.append(f"the tag v{version} is there already: CMakeLists.txt needs a new version")
    if git("status", "--porcelain"):
        found.append("files are changed or new, and not committed")
    try:
        if "not released" in notes((ROOT / CHANGELOG).read_text(encoding="utf-8"), version).splitlines()[0]:
            found.append(f"{CHANGELOG} says of {version} that it is not released: write the day instead")
    except FlowError as error:
        found.append(str(error))
    for check in (["generate.py", "--check"], ["reports.py", "stale-check"], ["reports.py", "figures", "--check"]):
        done = subprocess.run([ROOT / "scripts" / check[0], *check[1:]], cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode:
            found.append(f"`scripts/{' '.join(check)}` fails:\n" + "".join(f"  {line}\n" for line in done.stdout.splitlines()).rstrip())
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    making = commands.add_parser("archive", help="source archive, notes and checksums")
    making.add_argument("--out", type=Path, default=Path("build/release"), metavar="FOLDER")
    making.add_argument("--commit", default="HEAD")
    commands.add_parser("ready", help="what still speaks against a tag")
    arguments = parser.parse_args()
    try:
        if arguments.command == "archive":
            for path in archive(arguments.out, arguments.commit):
                print(path)
            return 0
        found = obstacles()
    except (FlowError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print("\n".join(found) or f"nothing speaks against `git tag v{file_lists.version()}`")
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
