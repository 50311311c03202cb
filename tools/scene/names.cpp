// Words of scene files: how views, walks, and parts of fields are called, and what a layer may be called.
#include <algorithm>
#include <cctype>
#include <iterator>

#include "tools/scene/layers.hpp"
#include "tools/scene/named.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::scene {
namespace {

constexpr const char* kElements[] = {"regular", "wedge", "trisector", "node", "centre", "saddle"};
constexpr const char* kFieldBrushes[] = {"comb", "smooth"};
constexpr const char* kViews[] = {"shaded", "charts", "normals", "lod", "layer", "depth", "overdraw", "field"};
constexpr const char* kGrounds[] = {"none", "meadow", "studio"};
constexpr const char* kWalks[] = {"intrinsic", "paper"};

}  // namespace

bool viewNamed(const std::string& name, EspView& out) {
    return valueNamed(kViews, name, out);
}

const char* nameOf(EspView view) {
    return size_t(view) < std::size(kViews) ? kViews[view] : "shaded";
}

bool groundNamed(const std::string& name, EspGround& out) {
    return valueNamed(kGrounds, name, out);
}

const char* nameOf(EspGround ground) {
    return kGrounds[ground];
}

bool walkNamed(const std::string& name, EspWalkMode& out) {
    return valueNamed(kWalks, name, out);
}

const char* nameOf(EspWalkMode walk) {
    return kWalks[walk];
}

bool elementNamed(const std::string& name, EspElementKind& out) {
    return valueNamed(kElements, name, out);
}
bool fieldBrushNamed(const std::string& name, EspFieldBrush& out) {
    return valueNamed(kFieldBrushes, name, out);
}

bool isLayersName(const std::string& name, std::string& why) {
    const auto part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    const bool channel = name.ends_with(".r") || name.ends_with(".g") || name.ends_with(".b");
    const std::string stem = channel ? name.substr(0, name.size() - 2) : name;
    if (!stem.empty() && std::ranges::all_of(stem, part)) return true;
    why = "'" + name +
          "' is no layer's name: a grammar's are of letters, digits and _, and a colour's channels end in .r, .g or .b";
    return false;
}

}  // namespace espalier::scene
