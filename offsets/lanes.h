// SIMD functions of the offsets: values for SolidProgram::draw_native, SolidProgram::lines_native
// and Fattener::fatten_inside.
#pragma once

#include "core/canvas/fatten.h"
#include "core/native/canvas.h"

namespace farcull {

void draw_obb_native(const NativeJob& job);
void follow_obb_native(const NativeLines& lines);
void fatten_obb_inside(const FattenBatch& batch);
void draw_minkowski_native(const NativeJob& job);
void follow_minkowski_native(const NativeLines& lines);
void fatten_minkowski_inside(const FattenBatch& batch);

}  // namespace farcull
