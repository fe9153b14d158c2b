// SPDX-License-Identifier: BSD-3-Clause
// LeakSanitizer's suppressions: OSMesa 22.3 keeps 480 bytes of every destroyed context.

extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa";
}
