// SPDX-License-Identifier: BSD-3-Clause
// An OpenGL context in memory: no display, no GPU.
#pragma once

#include <GL/osmesa.h>

#include <memory>
#include <vector>

namespace waymark {

/// Current in the thread that made it; everything drawn goes to framebuffer objects.
class GlContext {
 public:
  /// @throws SimulatorError when OSMesa gives none.
  GlContext();

 private:
  struct Destroy {
    void operator()(osmesa_context* context) const { OSMesaDestroyContext(context); }
  };

  std::vector<unsigned char> window_;  // OSMesa wants one, nothing is drawn there
  std::unique_ptr<osmesa_context, Destroy> context_;
};

}  // namespace waymark
