#pragma once

// How many calls of the plugin's functions that read, paint, fill and import layers there are until one fails as if
// memory had run out; 0: none does. Of the calls of this program only, the document's and the sample game's.
extern int callsUntilFailure;
