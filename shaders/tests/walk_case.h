// One walk of many steps with turns in between, run alike by tests/walk.comp and by the C++ test.
#ifndef ESPALIER_TESTS_WALK_CASE_H
#define ESPALIER_TESTS_WALK_CASE_H
#include "shaders/shared/walk.h"

ESPALIER_BEGIN

// 36 bytes. turn: radians after each step.
struct WalkCase {
    uint place;
    vec2 uv;
    vec3 direction;
    float step;
    float turn;
    uint steps;
};
STATIC_SIZE(WalkCase, 36);

// 52 bytes.
struct WalkEnd {
    Walk walk;
    vec3 position;
    uint event;     // the last one
    uint steps;     // finished
    uint samples;   // recorded, joints among them
};
STATIC_SIZE(WalkEnd, 52);

BUFFER(WalkCaseBuf, WalkCase)
BUFFER(WalkEndBuf, WalkEnd)

FN WalkEnd walkCase(SurfaceBuf surfaces, uint level, WalkCase c) {
    WalkEnd end;
    WalkState w;
    bool alive = startWalk(surfaces, level, c.place, c.uv, c.direction, w);
    end.event = alive ? kWalkRetry : kWalkLost;
    end.steps = 0u;
    end.samples = 0u;
    float remaining = c.step;
    while (alive && end.steps < c.steps) {
        vec3 jointNormal;
        end.event = walkAdvance(surfaces, level, w, remaining, jointNormal);
        end.samples += walkHasSample(end.event) ? 1u : 0u;
        alive = end.event < kWalkOpen;
        if (end.event == kWalkDone) {
            end.steps += 1u;
            remaining = c.step;
            rotateHeading(w, c.turn);
        }
    }
    end.walk = w.walk;
    end.position = w.position;
    return end;
}

ESPALIER_END
#endif
