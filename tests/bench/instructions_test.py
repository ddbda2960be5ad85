#!/usr/bin/env python3
"""Shows that the comparison of instruction counts can fail, and says by how much."""

import pathlib
import unittest

import instructions

DUMP = """# callgrind format
version: 1
part: 1
desc: Trigger: Client Request: kernel, mean 1
events: Ir
fn=(1) f
0 100
totals: 100

part: 2
desc: Trigger: Client Request: another
summary: 70
totals: 70

part: 3
desc: Trigger: Program termination
totals: 3
"""


def kernel(count):
    return {"unit": "pixel", "instructions": count}


class InstructionCounts(unittest.TestCase):
    def test_are_read_by_the_name_of_the_request(self):
        self.assertEqual(instructions.totals_of(DUMP), {"kernel, mean 1": 100, "another": 70})

    def test_may_stay_or_fall_or_grow_a_little(self):
        for count in (100, 20, 104.9):
            self.assertEqual(list(instructions.slower({"k": kernel(100)}, {"k": kernel(count)})), [])

    def test_that_grow_are_named_with_their_growth(self):
        found = list(instructions.slower({"k": kernel(100), "l": kernel(1)}, {"k": kernel(112), "l": kernel(1)}))
        self.assertEqual(found, ["k: 112 instructions a pixel, recorded 100: +12.0 %"])

    def test_must_be_in_the_record_and_measured(self):
        found = list(instructions.slower({"old": kernel(1)}, {"new": kernel(1)}))
        self.assertEqual(found, ["new: measured, but not in the record", "old: in the record, but not measured any more"])

    def test_show_what_effects_cost_that_are_off(self):
        usual, pruned = instructions.OFF_EFFECTS
        self.assertEqual(list(instructions.costly_when_off({usual: kernel(1009), pruned: kernel(1000)})), [])
        found = list(instructions.costly_when_off({usual: kernel(1030), pruned: kernel(1000)}))
        self.assertEqual(found, ["effects that are off cost 3.00 % of an exposure, not at most 1 %"])

    def test_cannot_be_measured_without_the_program(self):
        with self.assertRaises(instructions.CannotMeasure):
            instructions.measure(str(pathlib.Path(__file__).with_name("not_there")))


if __name__ == "__main__":
    unittest.main()
