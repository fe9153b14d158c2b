// SPDX-License-Identifier: BSD-3-Clause
// An OpenGL context in memory, without display and GPU.
#pragma once

#include <GL/osmesa.h>

#include <memory>
#include <vector>

namespace waymark {

/// Current in the thread that created it. Pictures are drawn to framebuffer objects.
class GlContext {
 public:
  /// @throws SimulatorError when OSMesa cannot create a context.
  GlContext();

 private:
  struct Destroy {
    void operator()(osmesa_context* context) const { OSMesaDestroyContext(context); }
  };

  std::vector<unsigned char> window_;  // required by OSMesa; nothing is drawn there
  std::unique_ptr<osmesa_context, Destroy> context_;
};

}  // namespace waymark
