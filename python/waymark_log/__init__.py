# SPDX-License-Identifier: BSD-3-Clause
"""Waymark's LCM logs in Python: events with the standard library, arrays with numpy (see README.md beside this folder)."""

from .events import Event, LogReader, LogWriter, messages

__all__ = ["Event", "LogReader", "LogWriter", "messages"]
