#pragma once

// What emission's kernels do, done at once: where runsAtOnce() says so, and nothing in flight uses what they do it to.
// Each function does the work of several kernels together, in an order of its own.

#include "runtime/host/bind.hpp"
#include "runtime/host/carry.hpp"
#include "runtime/host/cull.hpp"
#include "runtime/host/tiles.hpp"
#include "runtime/host/triangles.hpp"
#include "runtime/run/at_once.hpp"
