# SPDX-License-Identifier: Apache-2.0
"""parameters.toml against the RTL, which has its own DTOF_REQUIRE for each limit, and against itself."""

import ast
import itertools
import re
import unittest
from pathlib import Path

import generate
import limits
import readouts_cpp
from dtof_synth import readouts
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
TABLE = readouts.load()
LIMITS = limits.load()
TEXT = limits.PATH.read_text(encoding="utf-8")
REQUIRE = re.compile(r"`DTOF_REQUIRE\(\w+,\s*(.*?),\s*(?:\"(\w+): ([^\"]+)\"|`DTOF_READOUT_RANGE)\)\n", re.DOTALL)
CHOICE = re.compile(r"\(\(([^()?]+)\) \? (\w+) : (\w+)\)")
TOPS = ("dtof_array", "dtof_pool_pointer_array", "dtof_subsystem")


def required(top: str) -> dict[str, str]:
    """Conditions of a top's DTOF_REQUIRE by their sentences."""
    text = (ROOT / generate.rtl_of(top)).read_text(encoding="utf-8")
    return {sentence: condition for condition, _, sentence in REQUIRE.findall(text) if sentence}


def python(condition: str, top: str) -> str:
    """A condition of the RTL in Python."""
    source = (ROOT / generate.rtl_of(top)).read_text(encoding="utf-8")
    condition = re.sub(r"\bACQUISITION_LINES\b", lambda _: f"({re.findall(r'localparam int ACQUISITION_LINES = ([^;]+);', source)[0]})", condition)
    for readout in TABLE.readouts.values():
        condition = re.sub(rf"dtof_pkg::{readout.constant}\b", str(readout.number), condition)
    condition = CHOICE.sub(r"(\2 if \1 else \3)", condition)
    return " ".join(condition.replace("&&", " and ").replace("||", " or ").replace("$clog2", "clog2").split())


def samples(top: str, parameter: str) -> list[int]:
    """Values of a parameter on either side of its limits."""
    if parameter == "READOUT":
        return [0, 2, 8]
    default = TABLE.default("poolpointer" if "pool" in top else "ezpointer", parameter, 10) if parameter in TABLE.parameters else 2
    ends = {default}
    values = {name: TABLE.default("ezpointer", name, 10) for name in TABLE.parameters}
    for limit in LIMITS.of(top, parameter):
        ends |= {limits.evaluate(end, values) for end in (limit.lowest, limit.highest) if end is not None}
    return sorted({value + step for value in ends for step in (-2, -1, 0, 1, 2)})


class OfTheRtl(unittest.TestCase):
    def test_sentences_are_those_of_the_rtl(self):
        for top in TOPS:
            with self.subTest(top=top):
                self.assertEqual(set(required(top)), {limit.sentence for limit in LIMITS.of(top) if limit.required})

    def test_conditions_are_those_of_the_rtl(self):
        compared = 0
        for top in TOPS:
            conditions = required(top)
            for limit in LIMITS.of(top):
                if not limit.required:
                    continue
                if not limit.expression:
                    self.assertIn(limit.unknown, conditions[limit.sentence])
                    continue
                theirs = python(conditions[limit.sentence], top)
                ours = limit.expression
                names = sorted({node.id for node in ast.walk(ast.parse(f"({theirs}) + ({ours})")) if isinstance(node, ast.Name)} - {"min", "max", "clog2"})
                for values in itertools.product(*(samples(top, name) for name in names)):
                    setting = dict(zip(names, values))
                    if setting.get("ADVANTAGE_WIDTH") not in (None, 4, 7) and limit.parameter != "ADVANTAGE_WIDTH":
                        continue  # another limit refuses it
                    if setting.get("NP", 3) < 3 or setting.get("SLOTS", 1) < 1:
                        continue
                    legal = bool(eval(theirs, {"clog2": lambda n: max(n - 1, 0).bit_length()}, setting))
                    whole = bool(limits.evaluate(ours, setting)) or (limit.readout != "" and setting["READOUT"] != TABLE.readouts[limit.readout].number)
                    self.assertEqual(whole, legal, (top, limit.sentence, setting))
                    compared += 1
        self.assertGreater(compared, 500)


class OfItself(unittest.TestCase):
    def test_the_table_breaks_the_limit_that_it_names(self):
        for top, settings, sentence in (row.split(",", 2) for row in limits.csv(LIMITS, TABLE).splitlines() if row.startswith("dtof_")):
            given = {name: int(value) for name, value in re.findall(r"(\w+)=(-?\d+)", settings)}
            number = given.pop("READOUT", 64 if "pool" in top else 0)
            name = next((readout.name for readout in TABLE.readouts.values() if readout.number == number), "poolpointer")
            values = {"BUFFER_LINES": 2, "CLOCK_WAITS": 1, "SOURCE_WAITS": 1, "RASTER_ORDER": 0, "PARITY": 0, "SELF_TEST": 0}
            values |= {parameter: TABLE.default(name, parameter, given.get("NP", 10)) for parameter in TABLE.parameters} | given
            broken = [limit.sentence for limit in LIMITS.of(top) if limit.expression and limit.required and not limits.evaluate(limit.expression, values)
                      and limit.readout in ("", name)]
            computed = {limit.sentence for limit in LIMITS.of(top) if not limit.condition and limit.unknown}
            with self.subTest(top=top, settings=settings):
                if sentence in computed:
                    self.assertEqual([one for one in broken if one not in computed], [])
                else:
                    self.assertEqual(broken[:1], [sentence] if sentence else [])  # a model refuses with the first one

    def test_a_parameter_without_limit_is_refused(self):
        without = re.sub(r"\nNB = \{ from.*", "", TEXT)
        with self.assertRaisesRegex(FlowError, "dtof_array: NB has no limit"):
            limits.check(limits.parse(without), TABLE)
        with self.assertRaisesRegex(FlowError, "dtof_array has no parameter NX"):
            limits.check(limits.parse(TEXT.replace("\nNB = { from", "\nNB = { from = 1 }\nNX = { from")), TABLE)

    def test_refusals(self):
        for wrong, sentence in (("NP = { from = 3, to = 16", "FROM = { from = 3, too = 16"), ("from = 8\nto = 10\n", "")):
            with self.subTest(wrong=wrong), self.assertRaises(FlowError):
                limits.parse(TEXT.replace(wrong, sentence, 1))
        for text in ("NX + 1", "NP +", "__import__(1)", "'a'"):
            with self.subTest(text=text), self.assertRaises(FlowError):
                limits.evaluate(text, {"NP": 10})


class Written(unittest.TestCase):
    def test_cpp_means_the_same(self):
        self.assertEqual(limits.cpp("NP >= 3 and NP <= min(NB, 16 - 1)", str.lower), "((np >= 3) && (np <= std::min(nb, (16 - 1))))")
        self.assertEqual(limits.cpp("NP <= (4 if NB == 4 else 2) or (NP & 1) == 0", str.lower),
                         "((np <= ((nb == 4) ? 4 : 2)) || ((np & 1) == 0))")

    def test_help_and_page(self):
        self.assertEqual(limits.legal_text(LIMITS, TABLE, "NP"), "3 to 16 bits; poolPointer: 8 to 16 bits")
        self.assertEqual(limits.legal_text(LIMITS, TABLE, "POINTER_STEP"), "1 to 2^(NP-1) - 1")
        self.assertTrue(limits.page_row(LIMITS, TABLE, "dtof_array", "COUNT_WIDTH", "10").startswith("| `COUNT_WIDTH` | 1 to 16 | 10 | bits | 1 to 8 |"))
        self.assertIn("| 0 or 2 to 6; 0 if RIVAL_MOVES is 0 | 6 | bits |", limits.page_row(LIMITS, TABLE, "dtof_pool_pointer_array", "OFFSET_BITS", "6"))

    def faults_of_the_subsystems_table(self, found: limits.Limits) -> list[str]:
        """Own parameters of dtof_subsystem whose row lacks something, or has another default than the RTL."""
        source = (ROOT / generate.rtl_of("dtof_subsystem")).read_text(encoding="utf-8")
        begin, _, rest = source.partition("    // parameters of the arrays")
        _, _, own = rest.partition("    // end of parameters of the arrays")
        declared = re.findall(r"^    parameter int (\w+) = ([^,\n]+),?", begin + own.partition(") (\n")[0], re.MULTILINE)
        faults = []
        for name, default in declared:
            row = next((row for row in limits.subsystem_rows(found) if row.startswith(f"| `{name}` |")), "| | | the array's | as in the array |")
            _, _, _, shown, meaning, _ = (cell.strip() for cell in row.split("|"))
            if shown == "the array's" or meaning == "as in the array" or (default.isdigit() and shown != default):
                faults.append(name)
        self.assertGreaterEqual(len(declared), 6)
        # The shares are among the arrays' parameters in the RTL, and come from readouts.toml.
        for name in ("COARSE_SHARE", "TRACK_SHARE"):
            (limit,) = found.of("dtof_subsystem", name)
            lean = TABLE.default("poolpointer-lean", name, 10)
            if limit.default != str(TABLE.default("poolpointer", name, 10)) or (str(lean) != limit.default and f"{lean} for poolPointer lean" not in limit.meaning):
                faults.append(name)
        return faults

    def test_the_page_has_the_own_parameters_of_the_subsystem(self):
        self.assertEqual(self.faults_of_the_subsystems_table(LIMITS), [])
        ends = "[limit.dtof_subsystem.RASTER_ORDER]\nfrom = 0\nto = 1\n"
        without = limits.parse(TEXT.replace(f'{ends}default = "0"\n', ends))
        self.assertEqual(self.faults_of_the_subsystems_table(without), ["RASTER_ORDER"])
        share = limits.parse(TEXT.replace('default = "30"', 'default = "31"'))
        self.assertEqual(self.faults_of_the_subsystems_table(share), ["TRACK_SHARE"])
        other = limits.parse(TEXT.replace('default = "1"\nmeaning = "0: for', 'default = "0"\nmeaning = "0: for'))
        self.assertEqual(self.faults_of_the_subsystems_table(other), ["SOURCE_WAITS"])

    def test_keys_of_the_sensor_file_have_the_same_limits(self):
        """`dtof sensor --keys` prints the table of the page, and a test compares both."""
        page = (ROOT / "docs/user/sensor_file.md").read_text(encoding="utf-8")
        for key, parameter in (("timestamp_bits", "NP"), ("slots", "SLOTS")):
            (limit,) = LIMITS.of("dtof_array", parameter)
            self.assertRegex(page, rf"\n\| `{key}` \| {TABLE.parameters[parameter].default} \| {limit.legal}: [^|]+ \| {parameter}, ")

    def test_members_have_the_defaults(self):
        lists = readouts_cpp.member_lists(TABLE, LIMITS)
        self.assertIn("int confidence_width = 4;", lists["members of all read-outs"])
        self.assertIn("bool rival_moves = true;", lists["members of a pool read-out"])


if __name__ == "__main__":
    unittest.main()
