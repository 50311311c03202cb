// The table of node kinds as the plugin tells it.
#include "tools/document/node_kinds.hpp"

#include <algorithm>
#include <iterator>

namespace espalier::document {
namespace {

NodePort portOf(const EspNodePort& info) {
    NodePort port{info.name, info.unit, info.help, info.type, info.wired != 0, info.many != 0, info.asFirst != 0,
                  info.low,  info.high, {},        {}};
    std::copy(std::begin(info.standard), std::end(info.standard), port.standard.begin());
    if (info.text) port.text = info.text;
    if (info.opener) port.opener = info.opener;
    return port;
}

std::vector<NodeKind> readKinds() {
    std::vector<NodeKind> kinds(espNodeKindCount());
    for (uint32_t k = 0; k < kinds.size(); ++k) {
        EspNodeKind info;
        if (espNodeKindInfo(k, &info) != ESP_OK) continue;
        kinds[k] = {info.name, info.help, info.group, {}, {}};
        EspNodePort port;
        for (uint32_t i = 0; i < info.inputs; ++i) {
            if (espNodeInput(k, i, &port) != ESP_OK) continue;
            kinds[k].inputs.push_back(portOf(port));
            for (uint32_t w = 0; w < port.words; ++w) kinds[k].inputs.back().words.emplace_back(espNodeWord(k, i, w));
        }
        for (uint32_t o = 0; o < info.outputs; ++o)
            if (espNodeOutput(k, o, &port) == ESP_OK) kinds[k].outputs.push_back(portOf(port));
    }
    return kinds;
}

int placeOf(const std::vector<NodePort>& ports, const std::string& wanted) {
    const auto found = std::ranges::find(ports, wanted, &NodePort::name);
    return found == ports.end() ? -1 : int(found - ports.begin());
}

}  // namespace

int NodeKind::input(const std::string& wanted) const {
    return placeOf(inputs, wanted);
}

int NodeKind::output(const std::string& wanted) const {
    return wanted.empty() ? (outputs.empty() ? -1 : 0) : placeOf(outputs, wanted);
}

std::span<const NodeKind> nodeKinds() {
    static const std::vector<NodeKind> kinds = readKinds();
    return kinds;
}

const NodeKind* findNodeKind(const std::string& name) {
    const auto kinds = nodeKinds();
    const auto found = std::ranges::lower_bound(kinds, name, {}, &NodeKind::name);
    return found != kinds.end() && found->name == name ? &*found : nullptr;
}

int numbersOf(EspNodeType type) {
    if (type == ESP_NODE_VECTOR || type == ESP_NODE_COLOUR) return 3;
    return type == ESP_NODE_NUMBER || type == ESP_NODE_WHOLE ? 1 : 0;
}

bool isText(EspNodeType type) {
    return type == ESP_NODE_CHOICE || type == ESP_NODE_TEXT || type == ESP_NODE_FILE;
}

bool isGeometry(EspNodeType type) {
    return type >= ESP_NODE_POINTS;
}

bool canBeShown(EspNodeType type) {
    return isGeometry(type) || (type >= ESP_NODE_SURFACE && type <= ESP_NODE_LAYER);
}

}  // namespace espalier::document
