#pragma once

// Structs of the ABI that may grow. Their first field is their size as the host's header has it; nothing beyond that
// size is the host's, and it is neither read nor written.

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>

#include "plugin_api/espalier.h"

namespace espalier {

// Why what a host gave can't be used. guarded() makes ESP_INVALID_ARGUMENT of it.
struct Refusal {
    std::string why;
};

// What fields have that an older header lacks, and that espDefault... gives; of other structs zeros.
template <class T>
void setDefaults(T&) {}
void setDefaults(EspBrush& brush);
void setDefaults(EspCamera& camera);
void setDefaults(EspGrowDef& def);
void setDefaults(EspDrawDef& def);
void setDefaults(EspFieldDef& def);
void setDefaults(EspPassDef& def);
void setDefaults(EspPassFormat& format);
void setDefaults(EspLayerDef& def);
void setDefaults(EspLoadingDef& def);
void setDefaults(EspLook& look);
void setDefaults(EspPartsDef& def);
void setDefaults(EspSeedDef& def);
void setDefaults(EspStreamingDef& def);
void setDefaults(EspTownDef& def);

// Of a struct that a host has given to the function `call`: as many bytes as its header and ours both know.
template <class T>
size_t sharedSize(const char* call, const T* given) {
    static_assert(std::is_trivially_copyable_v<T> && offsetof(T, structSize) == 0);
    if (!given) throw Refusal{std::string(call) + ": null pointer"};
    if (given->structSize <= sizeof(uint32_t) || given->structSize > sizeof(T))
        throw Refusal{std::string(call) + ": a struct's structSize is " + std::to_string(given->structSize) +
                      ": it has to be the sizeof of that struct, which is at most " + std::to_string(sizeof(T)) +
                      " in this version"};
    return given->structSize;
}

// Copies all fields but the size between a host's struct and one of ours.
template <class T>
void copyFields(T* to, const T* from, size_t size) {
    constexpr size_t kFirst = sizeof(uint32_t);
    std::memcpy(reinterpret_cast<char*>(to) + kFirst, reinterpret_cast<const char*>(from) + kFirst, size - kFirst);
}

template <class T>
T taken(const char* call, const T* given) {
    T def{};
    setDefaults(def);
    copyFields(&def, given, sharedSize(call, given));
    return def;
}
// Likewise of one that a def leads to. Null: `otherwise`.
template <class T>
T takenOr(const char* call, const T* given, const T& otherwise) {
    return given ? taken(call, given) : otherwise;
}

template <class T>
void give(const char* call, T* out, const T& value) {
    copyFields(out, &value, sharedSize(call, out));
}

}  // namespace espalier
