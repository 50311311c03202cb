#pragma once

#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace espalier::test {

// Bytes that the process holds from malloc, in all threads' arenas; glibc only.
inline size_t heapInUse() {
    char* text = nullptr;
    size_t size = 0;
    FILE* file = open_memstream(&text, &size);
    if (!file) return 0;
    malloc_info(0, file);
    std::fclose(file);
    const std::string info(text, size);
    std::free(text);
    // The totals of all arenas come last.
    auto total = [&](const char* what) -> size_t {
        const size_t at = info.rfind(what), bytes = info.find("size=\"", at);
        return at == std::string::npos ? 0 : std::strtoull(info.c_str() + bytes + 6, nullptr, 10);
    };
    return total("<system type=\"current\"") - total("<total type=\"fast\"") - total("<total type=\"rest\"") +
           total("<total type=\"mmap\"");
}

}  // namespace espalier::test
