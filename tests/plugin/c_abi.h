#ifndef ESPALIER_TESTS_C_ABI_H
#define ESPALIER_TESTS_C_ABI_H
/* What the files of test_c_abi share. */
#include "tests/plugin/check.h"

extern char surfacePath[1024];
extern const char* programPath; /* a file that is no surface */
extern int logged;              /* errors that the log was told of */

EspGrammarDef ivy(void);
EspSeed plant(EspContext* context, EspGrammar grammar, float x, float y, float z, uint32_t number);

/* A host's own instance, for this version of Vulkan, and device, made as vulkan.h's users make them. */
EspHostDevice makeHost(uint32_t apiVersion);
/* A context whose log counts; host and cache may be NULL. */
EspContext* create(const EspHostDevice* host, const char* cache);

/* Draws, reads back, and returns how many pixels differ from the first one: 0 would be an empty picture. */
size_t drawn(EspContext* context);

/* Mistakes that a host can make, each refused with a message. */
void badArguments(EspContext* context);

#endif
