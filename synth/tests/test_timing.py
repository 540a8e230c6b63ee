# SPDX-License-Identifier: Apache-2.0
"""What is read out of OpenSTA's reports."""

import unittest

from dtof_synth import timing


class Names(unittest.TestCase):
    def test_register_names_are_rtl_names(self):
        self.assertEqual(timing._readable("u_pixel_sequencer_first_slot_t1_o_DFFR_X1_copy5604", {
            "u_pixel_sequencer_first_slot_t1_o_DFFR_X1_copy5604": r"u_pixel_sequencer.first_slot_t1_o\\DFFR_X1_copy5604"}),
                         "u_pixel_sequencer.first_slot_t1_o")
        self.assertEqual(timing._readable(r"g_column[9].g_ez_pointer.u_column/u_pointer_builder.word_q[12]\\DFF_X1", {}),
                         "column u_pointer_builder.word_q[12]")
        self.assertEqual(timing._readable("g_column[0].genblk1.u_column/u_b.u_peak_sram.g_one_port.u_macro.g_160x6.u_macro", {}),
                         "column u_b.u_peak_sram")

    def test_the_slowest_path_is_that_of_the_least_slack(self):
        # A group of paths is reported after the other: the reset's first, then the clock's.
        report = """DTOF_PATH_MAX
Startpoint: rst_ni (input port clocked by clk)
Endpoint: c (recovery check against rising-edge clock clk)
  0.60 0.60 ^ rst_ni (in)
  0.00 0.60 ^ c/RN (DFFR_X1)
       0.60   data arrival time
  0.00 3.00 ^ c/CK (DFFR_X1)
             2.4000   slack (MET)
Startpoint: a (rising edge-triggered flip-flop clocked by clk)
Endpoint: b (rising edge-triggered flip-flop clocked by clk)
  0.00 0.00 ^ a/CK (DFF_X1)
  0.10 0.10 ^ a/Q (DFF_X1)
  0.10 0.20 v n1/Y (NAND2_X1)
  0.10 0.30 ^ n2/Y (INV_X1)
  0.00 0.30 ^ b/D (DFF_X1)
       0.30   data arrival time
  0.00 0.20 ^ b/CK (DFF_X1)
             -0.1000   slack (VIOLATED)
"""
        self.assertEqual(timing.Report(report, {})._slowest_path("DTOF_PATH_MAX"), ("a", "b", 2))


if __name__ == "__main__":
    unittest.main()
