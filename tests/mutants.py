#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Changes one operator of the sources at random, builds, runs the tests, and says which changes no test has noticed.

Each mutant is built and tested in the release folder, and undone. One that does not compile is not counted. A survivor is
a missing test, or a change that makes no difference: which, has to be looked at.

usage: tests/mutants.py [--count N] [--seed N] [--suite NAME]
  --suite  common (default): procs/common against its unit tests, those of the tools, and the transport's;
           slam: procs/slam/core against unit, property and statistics tests;
           detector, sim, viewer, doctor, evaluate, import: each folder against its own tests
"""
import argparse
import os
import pathlib
import random
import re
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[1]
BUILD = SOURCE / "build/release"
SUITES = {  # folder, build targets, which are test programs
    "common": ("procs/common", ["tests/unit/common/common_unit_test", "tests/unit/common/pictures_unit_test",
                               "tests/unit/tools/tools_unit_test", "tests/process/transport_test"]),
    "slam": (
        "procs/slam/core",
        ["tests/unit/slam/slam_unit_test", "tests/property/slam/slam_property_test", "tests/unit/slam/daily_life_test",
         "tests/property/slam/slam_drives_test"],
    ),
    "detector": ("procs/detector", ["tests/unit/detector/detector_unit_test", "tests/unit/detector/corner_refinement_test"]),
    "sim": ("procs/sim", ["tests/unit/sim/sim_unit_test"]),
    "viewer": ("procs/viewer", ["tests/unit/viewer/viewer_unit_test"]),
    "doctor": ("tools/doctor", ["tests/unit/doctor/doctor_unit_test", "tests/unit/doctor/doctor_faults_test"]),
    "evaluate": ("tools/evaluate", ["tests/unit/tools/tools_unit_test"]),
    "import": ("tools/import", ["tests/unit/import/import_unit_test"]),
}
CHANGES = [(r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" == ", " != "), (r" != ", " == "),
           (r" && ", " || "), (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "),
           (r" \+= ", " -= "), (r" -= ", " += "), (r"\+\+", "--"), (r"return true;", "return false;"),
           (r"return false;", "return true;"), (r"std::min\(", "std::max("), (r"std::max\(", "std::min(")]
LONGEST_TEST_S = 300


def places_in(folder):
    """(file, begin, end, replacement, line) of everything that can be changed; comments, strings, includes are left out."""
    places = []
    for path in sorted((SOURCE / folder).rglob("*.[ch]pp")):
        at = 0
        for number, line in enumerate(path.read_text().splitlines(keepends=True), 1):
            code = re.sub(r'"(\\.|[^"\\])*"', lambda m: "_" * len(m[0]), line.split("//")[0])
            if not code.lstrip().startswith(("#", "template", "using", "namespace")):
                for pattern, replacement in CHANGES:
                    places += [(path, at + found.start(), at + found.end(), replacement, number)
                               for found in re.finditer(pattern, code)]
            at += len(line)
    return places


def passes(*command, timeout=None):
    try:
        done = subprocess.run(command, cwd=SOURCE, capture_output=True, timeout=timeout, stdin=subprocess.DEVNULL)
        return done.returncode == 0
    except subprocess.TimeoutExpired:
        return False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=16)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--suite", choices=sorted(SUITES), default="common")
    options = parser.parse_args()
    folder, tests = SUITES[options.suite]
    targets = [pathlib.Path(test).name for test in tests]
    build = ["nice", "cmake", "--build", "--preset", "release", "--target", *targets]
    if not passes(*build) or not all(passes(BUILD / test, timeout=LONGEST_TEST_S) for test in tests):
        sys.exit("the tests do not pass as they are")
    places = places_in(folder)
    random.Random(options.seed).shuffle(places)
    killed, survivors = 0, []
    for path, begin, end, replacement, number in places:
        if killed + len(survivors) == options.count:
            break
        original = path.read_text()
        what = f"{path.relative_to(SOURCE)}:{number}: '{original[begin:end].strip()}' -> '{replacement.strip()}'"
        try:
            path.write_text(original[:begin] + replacement + original[end:])
            if not passes(*build):
                continue
            survives = all(passes("nice", BUILD / test, timeout=LONGEST_TEST_S) for test in tests)
        finally:
            path.write_text(original)
            os.utime(path)
        killed += not survives
        survivors += [what] if survives else []
        print(f"{'SURVIVES' if survives else 'killed'} {what}", flush=True)
    passes(*build)
    print(f"{killed} of {killed + len(survivors)} mutants of {folder} were noticed (seed {options.seed})")


if __name__ == "__main__":
    main()
