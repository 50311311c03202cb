#pragma once

#include <exception>
#include <new>
#include <string>

namespace espalier::scene {

// Runs a part that says whether it went well. What a library throws, and want of memory, is a failure like others:
// `error` begins with `where`, such as "FILE: ".
template <class F>
bool guarded(const std::string& where, std::string& error, F&& part) {
    try {
        return part();
    } catch (const std::bad_alloc&) {
        error = where + "memory has run out";
    } catch (const std::exception& mistake) {
        error = where + mistake.what();
    }
    return false;
}

}  // namespace espalier::scene
