# SPDX-License-Identifier: Apache-2.0
import re
import unittest
from pathlib import Path

import registers
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
TEXT = registers.PATH.read_text(encoding="utf-8")
SMALL = """
id = 0x1234
major = 2
minor = 3
[register.SPEED]
offset = 0x00C
help = "how fast"
fields.NOW = { bits = [0, 7], access = "status", help = "now" }
fields.WANTED = { bits = [8, 15], access = "setting", help = "wanted" }
[register.DOOR]
offset = 0x010
number = 2
help = "who is in"
fields.COUNT = { bits = [4, 31], access = "constant", help = "people" }
[result]
WORD = { bits = [8, 63], help = "all" }

[amplitude_result]
LIGHT = { bits = [40, 55], help = "part" }

[short_result]
HALF = { bits = [5, 31], help = "most" }
"""


class Descriptions(unittest.TestCase):
    def test_bad_descriptions_are_refused(self):
        for change, message in (
            (("offset = 0x010", "offset = 0x012"), "multiple of 4"),
            (("offset = 0x010", "offset = 0x1000"), "below 4096"),
            (("offset = 0x010", "offset = 0x008"), "DOOR has the offset of SPEED"),
            (("bits = [8, 15]", "bits = [7, 15]"), "another field has its bits"),
            (("bits = [8, 15]", "bits = [8, 32]"), "highest of 0 to 31"),
            (("bits = [8, 15]", "bits = [15, 8]"), "lowest and the highest"),
            (("bits = [8, 63]", "bits = [8, 64]"), "highest of 0 to 63"),
            (("bits = [40, 55]", "bits = [40, 64]"), "amplitude_result.LIGHT: bits must be .* highest of 0 to 63"),
            (("bits = [5, 31]", "bits = [5, 32]"), "short_result.HALF: bits must be .* highest of 0 to 31"),
            (('"setting"', '"command"'), "a command has one bit"),
            (('"setting"', '"wish"'), "access must be one of"),
            (('"setting"', '"setting", reset = 256'), "a number of its bits"),
            (('"setting"', '"setting", reset = "soon"'), "or 'parameters'"),
            (('help = "all"', 'help = "all", access = "status"'), "has no access"),
            (('help = "who is in"', 'helps = "who is in"'), "helps"),
            (("major = 2", ""), "major"),
            (("id = 0x1234", "id ="), "registers.toml"),
        ):
            with self.subTest(change=change), self.assertRaisesRegex(FlowError, message):
                registers.parse(SMALL.replace(*change, 1))

    def test_constants_of_the_rtl(self):
        text = registers.systemverilog(registers.parse(SMALL))
        for line in ("localparam logic [31:0] VERSION_VALUE = 32'h00020003;",
                     "localparam logic [11:0] DOOR = 12'h010;", "localparam int DOOR_NUMBER = 2;",
                     "localparam int SPEED_WANTED_LSB = 8;", "localparam int SPEED_WANTED_WIDTH = 8;",
                     "localparam int RESULT_WORD_WIDTH = 56;", "localparam int AMPLITUDE_RESULT_LIGHT_LSB = 40;",
                     "localparam int SHORT_RESULT_HALF_LSB = 5;",
                     "is_register = (offset >= 12'h00c && offset <= 12'h014);",
                     "is_writable = offset == 12'h00c;"):  # fmt: skip
            self.assertIn(line, text)

    def test_reset_values(self):
        whole = registers.parse(SMALL.replace('"setting"', '"setting", reset = 0x5A'))
        self.assertEqual((whole.registers[0].reset_value, whole.registers[0].reset_mask), (0x5A00, 0xFFFFFFFF))
        self.assertIn("localparam logic [31:0] SPEED_RESET = 32'h00005a00;", registers.systemverilog(whole))
        self.assertIn("  X(DTOF_SPEED, 1, UINT32_C(0x00005A00), UINT32_C(0xFFFFFFFF)) \\", registers.c_header(whole))
        self.assertIn("  X(DTOF_DOOR, 2, UINT32_C(0x00000000), UINT32_C(0x0000000F))\n", registers.c_header(whole))

    def test_c_header(self):
        text = registers.c_header(registers.parse(SMALL))
        for line in ("#define DTOF_SPEED UINT32_C(0x00C)", "#define DTOF_SPEED_WANTED_MASK UINT32_C(0x0000FF00)",
                     "#define DTOF_DOOR_COUNT_LSB 4", "#define DTOF_RESULT_WORD_MASK UINT64_C(0xFFFFFFFFFFFFFF00)",
                     "#define DTOF_AMPLITUDE_RESULT_LIGHT_MASK UINT64_C(0x00FFFF0000000000)",
                     "#define DTOF_SHORT_RESULT_HALF_MASK UINT32_C(0xFFFFFFE0)"):  # fmt: skip
            self.assertIn(line, text)

    def test_tables(self):
        whole = registers.parse(SMALL)
        self.assertIn("| 0x010 to 0x014 | `DOOR` | | | | who is in |", registers.register_table(whole))
        self.assertIn("| | | 15:8 | `WANTED` | read, write | wanted |", registers.register_table(whole))
        self.assertIn("| 63:8 | `WORD` | all |", registers.result_table(whole.result))
        self.assertIn("| 55:40 | `LIGHT` | part |", registers.result_table(whole.amplitude_result))
        self.assertIn("| 31:5 | `HALF` | most |", registers.result_table(whole.short_result))
        with self.assertRaisesRegex(FlowError, "page.md has no place for the table of result word"):
            registers.page("# A page\n", "page.md", registers.result_tables(whole))

    def test_offsets_of_the_project_do_not_move_without_a_new_version(self):
        """Software is compiled with them: who moves one raises `major` and renews this list."""
        whole = registers.parse(TEXT)
        self.assertEqual(whole.major, 3)
        offsets = {register.name: register.offset for register in whole.registers}
        self.assertEqual(re.sub(r"\s", "", " ".join(f"{name}={offset:x}" for name, offset in offsets.items())),
                         "ID=0VERSION=4READOUT=8SIZE=cWIDTHS=10LINES=14SLOTS=18RAW_BINS=1cHISTOGRAM=20POINTER=24POOL=28"
                         "ENGINES=2cSHARES=30CONTROL=40STATUS=44ERROR=48IRQ_ENABLE=4c"
                         "IRQ_STATUS=50FRAME_COUNT=54FRAME_CYCLES=58WARNING=5cACQUISITIONS=60COARSE_END=64TRACK_END=68WATCHDOG=6c"
                         "GATE=70RELEASE=74WEAK_BELOW=78OUTPUT=7cCOLUMN_ENABLE=80RAW_ROWS=100"
                         "LOST_LINES=104LOST_ACQUISITIONS=108COMMIT=10cSHOT=110SHOT_SEED=114SHOT_STATE=118FRAME_CRC=11cPARITY_ERRORS=120TEMPLATE=124"
                         "SETTLE=144SELF_TEST_SEED=148SELF_TEST_EXPECTED=14c")


if __name__ == "__main__":
    unittest.main()
