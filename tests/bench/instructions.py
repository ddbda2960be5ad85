#!/usr/bin/env python3
"""Counts the instructions of the main kernels with callgrind and compares them with the record.

Times depend on who else uses the machine; instructions do not, so a kernel that got slower shows on any machine.
The record is reports/bench/instructions.json. Exit code 1: a kernel takes more instructions than the record allows, or
the record and the kernels do not match; 77: it cannot be measured here.
usage: tests/bench/instructions.py PROGRAM [--record]      (PROGRAM: the built instructions_bench)
"""

import argparse
import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RECORD = ROOT / "reports" / "bench" / "instructions.json"
OFF_EFFECTS = ("reference exposure", "reference exposure, no effect but those on")
ALLOWED_OFF = 0.01  # of an exposure, for all effects that are switched off together
ALLOWED = 0.05  # a compiler's whims on unrelated changes stay below it; a lost vectorisation is far above
SKIP = 77
HOW_TO_RECORD = "cmake --build --preset ci --target record-instructions"


class CannotMeasure(Exception):
    pass


def totals_of(dump):
    """Instructions by the name of the request that asked for the dump, from callgrind's combined file."""
    totals = {}
    name = None
    for line in dump.splitlines():
        trigger = re.fullmatch(r"desc: Trigger: Client Request: (.*)", line)
        if trigger:
            name = trigger[1]
        elif line.startswith("desc: Trigger:"):
            name = None  # the end of the program
        total = re.fullmatch(r"(?:summary|totals): (\d+)", line)
        if total and name is not None:
            totals[name] = int(total[1])
    return totals


def measure(program):
    """Runs the program under callgrind. @returns what it says of itself, with the instructions per unit of each kernel"""
    if not shutil.which("valgrind"):
        raise CannotMeasure("valgrind is not installed")
    if not pathlib.Path(program).is_file():
        raise CannotMeasure("the program was not built: valgrind/callgrind.h or a release build is missing")
    with tempfile.TemporaryDirectory() as folder:
        dump = pathlib.Path(folder, "callgrind.out")
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", "--instr-atstart=no", "--combine-dumps=yes", "--dump-line=no",
             f"--callgrind-out-file={dump}", program],
            capture_output=True, text=True, env={"PATH": os.environ["PATH"], "LC_ALL": "C"})
        if run.returncode == SKIP:
            raise CannotMeasure(run.stderr.strip().splitlines()[-1])
        if run.returncode != 0:
            sys.exit(f"{program} failed under valgrind:\n{run.stderr}")
        said = json.loads(run.stdout)
        totals = totals_of(dump.read_text())
    kernels = {kernel["name"]: {"unit": kernel["unit"], "instructions": round(totals[kernel["name"]] / kernel["units"], 3)}
               for kernel in said["kernels"]}
    return {"compiler": said["compiler"], "vectors": said["vectors"], "kernels": kernels}


def slower(recorded, measured):
    """Yields a sentence for each kernel that takes too many instructions, or that only one side knows."""
    for name in sorted({*recorded, *measured}):
        if name not in measured:
            yield f"{name}: in the record, but not measured any more"
        elif name not in recorded:
            yield f"{name}: measured, but not in the record"
        else:
            before, now = recorded[name]["instructions"], measured[name]["instructions"]
            if now > (1 + ALLOWED) * before:
                yield f"{name}: {now:g} instructions a {measured[name]['unit']}, recorded {before:g}: {100 * (now / before - 1):+.1f} %"


def costly_when_off(measured):
    """Yields a sentence if effects that are switched off cost more than they may."""
    usual, pruned = (measured[name]["instructions"] for name in OFF_EFFECTS)
    share = usual / pruned - 1
    if share > ALLOWED_OFF:
        yield f"effects that are off cost {100 * share:.2f} % of an exposure, not at most {100 * ALLOWED_OFF:g} %"


def print_table(recorded, measured):
    print(f"{'kernel':<46} {'recorded':>12} {'measured':>12}  per")
    for name, kernel in measured.items():
        before = recorded.get(name, {}).get("instructions")
        change = "" if before is None else f" {100 * (kernel['instructions'] / before - 1):+.1f} %"
        print(f"{name:<46} {before if before is not None else '-':>12} {kernel['instructions']:>12}  {kernel['unit']}{change}")


def record(measured):
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    valgrind = subprocess.run(["valgrind", "--version"], capture_output=True, text=True).stdout.strip()
    head = {"commit": commit or "unknown", "date": datetime.date.today().isoformat(), "valgrind": valgrind}
    RECORD.write_text(json.dumps(head | measured, indent=1) + "\n")
    print(f"recorded in {RECORD.relative_to(ROOT)}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("program")
    parser.add_argument("--record", action="store_true")
    arguments = parser.parse_args()
    recorded = json.loads(RECORD.read_text()) if RECORD.exists() else {"kernels": {}}
    try:
        measured = measure(arguments.program)
        if not arguments.record and measured["compiler"] != recorded.get("compiler", measured["compiler"]):
            raise CannotMeasure(f"the record is of {recorded['compiler']}, this program of {measured['compiler']}")
    except CannotMeasure as reason:
        print(f"skipped: {reason}")
        return SKIP
    print_table(recorded["kernels"], measured["kernels"])
    if arguments.record:
        record(measured)
        return 0
    offences = list(slower(recorded["kernels"], measured["kernels"]))
    expensive = list(costly_when_off(measured["kernels"]))
    print(*expensive, sep="\n")
    if offences:
        print(f"\nMore than {100 * ALLOWED:.0f} % above {RECORD.relative_to(ROOT)} (commit {recorded.get('commit')}):")
        print(*(f"  {offence}" for offence in offences), sep="\n")
        print(f"If that is intended, say why in the commit and record anew: {HOW_TO_RECORD}")
    return 1 if offences or expensive else 0


if __name__ == "__main__":
    sys.exit(main())
