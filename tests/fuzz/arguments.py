#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Random command lines, made of each program's own --help, for the programs as they are released.

The five processes are run with --check, the tools do what they are asked, in a folder with a short run and its map. No
program may be ended by a signal, take more than 20 s of processor time or 2 GB, fail without a sentence, or with one that
is not its own ("std::bad_alloc"). That of waymark-command, which would wait for an answer, is tried in process
(command_line.cpp).

usage: tests/fuzz/arguments.py [--runs N] [--seed N] [--bin DIR] [--only NAME]
"""
import argparse
import collections
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROCESSES = ("sim", "detector", "slam", "viewer", "recorder")
TOOLS = ("calibrate", "doctor", "evaluate", "export", "faults", "import", "map", "marker-sheet")
NUMBERS = ("0", "1", "-1", "3", "0.5", "1e-9", "1e9", "1e300", "-1e300", "nan", "inf", "99999999999999999999", "0x10", "1,5", "")
WORDS = ("", "a", "a/b", "..", "-", "--", "=", "a=b", "0-5,9", "5-0", "7x5", "0x0", "-1x-1", "A4", "DICT_4X4_50", "localise", "pose",
         "udpm://", "[1, 2]", "é", "\xff", "slam.mode=map", "run.seed=-1", "run.seed", "x" * 300, "%s%n")
FOREIGN = re.compile(r"terminate called|std::|basic_|vector|bad_|sto[idl]|filesystem error|Assertion|OpenCV|json\.exception")
LONGEST_S = 20
LARGEST_B = 2 << 30


def limit():
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST_S, LONGEST_S))
    resource.setrlimit(resource.RLIMIT_AS, (LARGEST_B, LARGEST_B))
    resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST_B // 10, LARGEST_B // 10))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Program:
    """What --help says: options with the type of their value, arguments by place, and subcommands."""

    def __init__(self, path, above=()):
        self.command = [path, *above]
        text = subprocess.run([*self.command, "--help"], capture_output=True, text=True).stdout
        self.options = re.findall(r"^  (?:-\w,)?(--[\w-]+)(?: ([A-Z]+))?(.*)", text, re.MULTILINE)
        self.places = re.findall(r"^  (\w+) ([A-Z]+)", text.partition("Positionals:")[2].partition("Options:")[0], re.MULTILINE)
        names = re.findall(r"^  ([a-z][\w-]*) ", text.partition("Subcommands:")[2], re.MULTILINE)
        self.subcommands = [] if above else [Program(path, [name]) for name in names]


class Runs:
    def __init__(self, options, folder):
        self.random = random.Random(options.seed)
        self.folder = folder
        self.make_run(options.bin)
        names = [options.only] if options.only else PROCESSES + TOOLS
        self.programs = [Program(options.bin / f"waymark-{name}") for name in names]

    def make_run(self, bin_dir):
        scripts = {SOURCE / "build/release": SOURCE / "deploy"}.get(bin_dir, bin_dir.parent / "share/waymark/deploy")
        subprocess.run([scripts / "launch.sh", SOURCE / "tests/data/scenarios/smallest.toml", "--out", self.folder / "kept",
                        "--save-map", self.folder / "kept.map.lcm"], check=True, capture_output=True)
        shutil.copytree(SOURCE / "tests/data/import", self.folder / "import")
        files = [path for path in self.folder.rglob("*") if path.is_file()]
        self.files = [str(path.relative_to(self.folder)) for path in files] + ["kept", "no_such_file", "."]

    def value(self, kind):
        if kind in ("INT", "UINT", "FLOAT", "NUMBER", "POSITIVE") and self.random.random() < 0.9:
            return self.random.choice(NUMBERS)
        return self.random.choice(self.random.choice((NUMBERS, WORDS, self.files, self.files)))

    def words_of(self, program):
        words = [self.value(kind) for _, kind in program.places if self.random.random() < 0.95]
        some = self.random.sample(program.options, self.random.randint(0, min(4, len(program.options))))
        needed = [option for option in program.options if "REQUIRED" in option[2] and self.random.random() < 0.9]
        for name, kind, _ in some + needed:
            words += [name, self.value(kind)] if kind else [name]
        if self.random.random() < 0.1:
            words.insert(self.random.randint(0, len(words)), self.random.choice(WORDS))
        return [word.replace("\xff", "\udcff") for word in words]

    def one(self):
        program = self.random.choice(self.programs)
        if program.subcommands and self.random.random() < 0.95:
            program = self.random.choice(program.subcommands)
        command = [*program.command, *self.words_of(program)]
        if command[0].name.removeprefix("waymark-") in PROCESSES:
            command.insert(1, "--check")
        with tempfile.TemporaryDirectory(dir=self.folder.parent) as work:
            copy = pathlib.Path(work) / "run"
            shutil.copytree(self.folder, copy)
            try:
                ended = subprocess.run(command, cwd=copy, capture_output=True, stdin=subprocess.DEVNULL, preexec_fn=limit,
                                       errors="replace", timeout=6 * LONGEST_S)
            except subprocess.TimeoutExpired:
                return command, "none", "does not end"
        said = ended.stderr + ended.stdout
        fault = ""
        if ended.returncode not in range(5):
            fault = "ended by a signal, or a strange code"
        elif ended.returncode != 0 and not said.strip():
            fault = "fails without a sentence"
        elif ended.returncode != 0 and (foreign := FOREIGN.search(ended.stderr)):
            fault = f"a sentence that is not ours: {foreign[0]}"
        return command, ended.returncode, fault and f"{fault}: {ended.stderr.strip()[-300:]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=1000, help="how many (1000)")
    parser.add_argument("--seed", type=int, default=1, help="of programs and words (1)")
    parser.add_argument("--bin", type=pathlib.Path, default=SOURCE / "build/release", help="where the programs are")
    parser.add_argument("--only", choices=PROCESSES + TOOLS, help="this program alone")
    options = parser.parse_args()
    options.bin = options.bin.resolve()
    outcomes = collections.Counter()
    faults = 0
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work) / "kept"
        folder.mkdir()
        runs = Runs(options, folder)
        for _ in range(options.runs):
            command, code, fault = runs.one()
            outcomes[command[0].name, code] += 1
            faults += bool(fault)
            if fault:
                print(f"{[command[0].name, *command[1:]]}: code {code}: {fault}".encode(errors="replace").decode(), flush=True)
    for (name, code), count in sorted(outcomes.items(), key=str):
        print(f"{name}: exit code {code}, {count} times")
    print(f"{options.runs - faults} of {options.runs} command lines ended as they should (seed {options.seed})")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
