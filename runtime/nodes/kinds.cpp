// The rows of all files, in one table by name.
#include "runtime/nodes/kinds.hpp"

#include <algorithm>

namespace espalier {
namespace {

template <class List>
int placeOf(const List& list, std::string_view wanted) {
    for (size_t i = 0; i < list.size(); ++i)
        if (list[i].name == wanted) return int(i);
    return -1;
}

std::vector<NodeKind> allKinds() {
    std::vector<NodeKind> all;
    struct Group {
        const char* name;
        std::vector<NodeKind> (*rows)();
    };
    constexpr Group kGroups[] = {{"Points", pointKinds},       {"Points", fluidKinds},   {"Curves", curveKinds},
                                 {"Meshes", meshKinds},        {"Meshes", scatterKinds}, {"Loops", loopKinds},
                                 {"Modifiers", modifierKinds}, {"Values", valueKinds},   {"Stages", stageKinds}};
    for (const Group& group : kGroups)
        for (NodeKind& kind : group.rows()) {
            kind.group = group.name;
            all.push_back(std::move(kind));
        }
    std::ranges::sort(all, {}, &NodeKind::name);
    return all;
}

}  // namespace

int NodeKind::port(std::string_view wanted) const {
    return placeOf(inputs, wanted);
}

int NodeKind::output(std::string_view wanted) const {
    return wanted.empty() ? 0 : placeOf(outputs, wanted);
}

std::span<const NodeKind> nodeKinds() {
    static const std::vector<NodeKind> kinds = allKinds();
    return kinds;
}

const NodeKind* findNodeKind(std::string_view name) {
    const auto kinds = nodeKinds();
    const auto found = std::ranges::lower_bound(kinds, name, {}, &NodeKind::name);
    return found != kinds.end() && found->name == name ? &*found : nullptr;
}

NodePort numberPort(const char* name, float standard, float low, float high, const char* unit, const char* help) {
    return {name, ValueType::number, standard, low, high, unit, help};
}
NodePort wholePort(const char* name, float standard, float low, float high, const char* help) {
    return {name, ValueType::whole, standard, low, high, "", help};
}
NodePort vectorPort(const char* name, glm::vec3 standard, float low, float high, const char* unit, const char* help) {
    return {name, ValueType::vector, standard, low, high, unit, help};
}
NodePort wirePort(const char* name, ValueType type, const char* help) {
    return {name, type, {}, 0, 0, "", help};
}
NodePort seedPort() {
    return wholePort("seed", 1, 0, 16777215, "another number gives other random numbers");
}

}  // namespace espalier
