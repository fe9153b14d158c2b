// SPDX-License-Identifier: BSD-3-Clause
// An OpenGL context in memory, without display and GPU.
#pragma once

#include <GL/osmesa.h>

#include <memory>
#include <vector>

namespace waymark {

/// The context is current in the thread that created it. Pictures are drawn to framebuffer objects.
class GlContext {
 public:
  /// @throws SimulatorError when OSMesa cannot create a context.
  GlContext();

 private:
  struct Destroy {
    void operator()(osmesa_context* context) const { OSMesaDestroyContext(context); }
  };

  std::vector<unsigned char> window_;  // buffer that OSMesa requires; nothing is drawn to it
  std::unique_ptr<osmesa_context, Destroy> context_;
};

}  // namespace waymark
