#ifndef ESPALIER_TESTS_CHECK_H
#define ESPALIER_TESTS_CHECK_H
/* For tests in plain C: a check that fails prints its line and ends the program with 1. */
#include <stdio.h>
#include <stdlib.h>

#include "plugin_api/espalier.h"

#define CHECK(condition)                                                            \
    do {                                                                            \
        if (!(condition)) {                                                         \
            fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                                \
        }                                                                           \
    } while (0)
#define OK(context, call)                                                                                          \
    do {                                                                                                           \
        EspResult result_ = (call);                                                                                \
        if (result_ != ESP_OK) {                                                                                   \
            fprintf(stderr, "%s:%d: %s gave %d: %s\n", __FILE__, __LINE__, #call, result_, espLastError(context)); \
            exit(1);                                                                                               \
        }                                                                                                          \
    } while (0)
#define REFUSED(call) CHECK((call) == ESP_INVALID_ARGUMENT)

#endif
