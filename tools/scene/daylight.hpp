#pragma once

#include "plugin_api/espalier.h"

namespace espalier::scene {

// The light of an hour of the day, 0 to 24: sets sun, sky, ground, background and horizon of `look`, nothing else.
// The sun rises at 6 in the east (+X), stands high in the south (+Z) at 12 and sets at 18; at night the moon shines.
void applyDaylight(float hour, EspLook& look);

}  // namespace espalier::scene
