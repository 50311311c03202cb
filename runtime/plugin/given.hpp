#pragma once

// What hosts give and are given: vectors as arrays, numbers that may be anything. Pointers aren't null unless it is
// said.

#include <cmath>
#include <cstring>
#include <glm/glm.hpp>

namespace espalier {

inline glm::vec3 vec(const float v[3]) {
    return {v[0], v[1], v[2]};
}
inline void put(float to[3], glm::vec3 from) {
    for (int i = 0; i < 3; ++i) to[i] = from[i];
}
inline bool finite(const float v[3]) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}
// A ray: its direction of any length but 0. Either may be null: then it is none.
inline bool isRay(const float* origin, const float* direction) {
    return origin && direction && finite(origin) && finite(direction) && vec(direction) != glm::vec3(0);
}

// Is what a host gave among the enumerators from `first` to `last`? It may be any number, which C++ mustn't look at as
// one.
template <class Enum>
bool isAmong(const Enum& given, Enum first, Enum last) {
    static_assert(sizeof(Enum) == sizeof(int));
    int number = 0;
    std::memcpy(&number, &given, sizeof number);
    return number >= int(first) && number <= int(last);
}

}  // namespace espalier
