#include "tools/scene/user_folders.hpp"

#include <cstdlib>

namespace espalier::scene {
namespace {

std::string below(const char* variable, const char* inHome) {
    if (const char* folder = std::getenv(variable); folder && *folder) return std::string(folder) + "/espalier";
    if (const char* home = std::getenv("HOME"); home && *home) return std::string(home) + inHome + "/espalier";
    return {};
}

}  // namespace

std::string configFolder() {
    return below("XDG_CONFIG_HOME", "/.config");
}
std::string cacheFolder() {
    return below("XDG_CACHE_HOME", "/.cache");
}

}  // namespace espalier::scene
