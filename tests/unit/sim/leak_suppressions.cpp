// SPDX-License-Identifier: BSD-3-Clause
// OSMesa 22.3 keeps 480 bytes per context that it has destroyed; LeakSanitizer asks here.

extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa";
}
