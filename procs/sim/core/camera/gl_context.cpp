// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/gl_context.hpp"

#include "sim/core/robot/physics.hpp"

namespace waymark {

GlContext::GlContext() {
  constexpr int kWindowSide_px = 64;
  constexpr int kDepthBits = 24;
  constexpr int kStencilBits = 8;
  constexpr int kAccumulationBits = 0;
  window_.resize(std::size_t{4} * kWindowSide_px * kWindowSide_px);
  context_.reset(
      OSMesaCreateContextExt(OSMESA_RGBA, kDepthBits, kStencilBits, kAccumulationBits, nullptr));
  if (!context_ || OSMesaMakeCurrent(context_.get(), window_.data(), GL_UNSIGNED_BYTE,
                                     kWindowSide_px, kWindowSide_px) == GL_FALSE) {
    throw SimulatorError{"OSMesa gives no OpenGL context; is libosmesa6 installed?"};
  }
}

}  // namespace waymark
