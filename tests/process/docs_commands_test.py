# SPDX-License-Identifier: BSD-3-Clause
"""Every command in the documentation names a program and options that are there, as its --help says.

usage: docs_commands_test.py SOURCE_DIR BUILD_DIR
"""

import functools
import re
import shlex
import subprocess
import sys
from pathlib import Path

DOCUMENTS = ("README.md", "docs/*.md", "tools/*/README.md", "procs/*/README.md", "tests/**/README.md", "deploy/**/README.md")
OURS = re.compile(r"^(?:\./)?(?:build/release/)?(waymark-[a-z-]+)$|^(?:\./)?((?:deploy|tests|tools)/\S+\.(?:sh|py))$")
BLOCK = re.compile(r"^ *```sh\n(.*?)^ *```", re.M | re.S)
INLINE = re.compile(r"`([^`\n]+)`")


def simple_commands(text):
    """Words of each command of a piece of shell; what shlex cannot read is none."""
    for line in text.replace("\\\n", " ").splitlines():
        try:
            lexer = shlex.shlex(line, posix=True, punctuation_chars="|&;<>()")
            lexer.whitespace_split, lexer.commenters = True, "#"
            words = list(lexer)
        except ValueError:
            continue
        command = []
        for word in [*words, ";"]:
            if set(word) <= set("|&;"):
                yield command
                command = []
            else:
                command.append(word)


@functools.cache
def help_text(program, *subcommands):
    interpreter = [sys.executable, "-B"] if program.suffix == ".py" else []
    done = subprocess.run([*interpreter, program, *subcommands, "--help"], capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
    return done.stdout + done.stderr if done.returncode == 0 else ""


def problems_of(words, source, build):
    """What is wrong with one command; nothing for those of others."""
    at = next((i for i, word in enumerate(words) if OURS.match(word)), None)
    if at is None:
        return
    match = OURS.match(words[at])
    program = build / match[1] if match[1] else source / match[2]
    if not program.is_file():
        yield f"there is no {words[at]}"
        return
    arguments = words[at + 1 :]
    known = help_text(program)
    if arguments and re.fullmatch("[a-z][a-z0-9-]*", arguments[0]) and re.search(rf"^  {arguments[0]} ", known, re.M):
        known += help_text(program, arguments[0])
    for argument in arguments:
        option = re.match(r"--[a-z][a-z0-9-]*", argument)
        if option and not re.search(re.escape(option[0]) + r"(?![a-z0-9-])", known):
            yield f"{words[at]} has no {option[0]}"


def main():
    source, build = (Path(argument).resolve() for argument in sys.argv[1:3])
    wrong, checked = [], 0
    for document in sorted({path for pattern in DOCUMENTS for path in source.glob(pattern)}):
        text = document.read_text()
        for piece in [*BLOCK.findall(text), *INLINE.findall(BLOCK.sub("", text))]:
            for words in simple_commands(piece):
                checked += any(OURS.match(word) for word in words)
                wrong += [f"{document.relative_to(source)}: {problem}" for problem in problems_of(words, source, build)]
    print(f"{checked} commands in the documentation")
    for problem in dict.fromkeys(wrong):
        print("FAILED:", problem)
    sys.exit(bool(wrong) or checked < 50)


if __name__ == "__main__":
    main()
