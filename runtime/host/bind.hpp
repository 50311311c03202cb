#pragma once

// Growth bound as native code, in the memory that kernels use.

#include <span>

#include "shaders/emit/emit_records.h"

namespace espalier {

// Leaves in all that `push` points to what the bind_*.comp kernels would: their own text compiled as C++, so roots and
// divisions may differ in their last bits. watched: its tiles are noted, if push.watched. Nothing may use any of it
// meanwhile. On up to `threads` threads (0: all cores); returns when done.
void bindNative(const BindInputs& push, const EmitTable& table, const EmitView& watched, unsigned threads = 0);

// About which share of the nodes stands on surface instances whose bit is set: of each word the lowest first.
float movedShare(NodeBuf nodes, uint32_t count, std::span<const uint32_t> bits);

}  // namespace espalier
