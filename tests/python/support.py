# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the tests of the Python package: where it is, and logs to read."""

import sys
import tempfile
import unittest
from pathlib import Path

build_dir = Path(sys.argv.pop(1)) if len(sys.argv) > 1 else Path("build/release")
package_dir = build_dir / "python"
sys.path.insert(0, str(package_dir))


def need(*names):
    """Ends the test as skipped where a module is missing."""
    for name in names:
        try:
            __import__(name)
        except ImportError:
            print(f"skipped: no {name} for {sys.executable}; apt-get install python3-{name}")
            sys.exit(77)


class InFolder(unittest.TestCase):
    """A test with a folder of its own, which goes with it."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
