#pragma once

#include <vector>

namespace espalier {

// Frees what vectors hold. Assigning {} empties a vector and keeps its memory.
template <class... T>
void letGo(std::vector<T>&... vectors) {
    (std::vector<T>().swap(vectors), ...);
}

}  // namespace espalier
